/*
 * A Modbus server on TCP, for several clients, and on one serial line. One thread; no client can
 * make it wait for another.
 *
 * libmodbus is not used on this side: its server waits inside modbus_receive for the rest of a
 * frame, so that one client who sends half a request would stop all others, and modbus_reply sleeps
 * half a second over a wrong quantity.
 */
#ifndef TAKT_SERVE_SERVER_H
#define TAKT_SERVE_SERVER_H

#include "modbus/rtu.h"
#include "serve/allow_list.h"
#include "serve/connection.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

/* When another client comes, the one that has been silent for longest goes. */
#define SERVER_CLIENTS_MAX 128

/* Places of clients; the last is the serial line. */
#define SERVER_PLACES (SERVER_CLIENTS_MAX + 1)

/* A request must be whole so long after its first byte; then the connection is closed. */
#define SERVER_REQUEST_MS 5000

/* Whose server it is. Called by the server's thread. */
struct server_host {
    /* A client takes a place: the registers as it sees them. */
    struct modbus_map (*enter)(void *context, unsigned place);
    void (*leave)(void *context, unsigned place);
    /* True: it must not go for another client. Not asked of the serial line. */
    bool (*keeps)(void *context, unsigned place);
    void *context; /* owned by whoever made it */
};

struct server_config {
    struct server_host host;
    const char *address; /* "127.0.0.1"; NULL: no TCP */
    const char *port;    /* "1502"; "0": any, see server_get_port */
    struct allow_list allowed;
    int serial; /* an open serial line; -1: none. Closed by server_close */
    uint32_t serial_gap_us;
    uint8_t unit; /* on the serial line */
};

struct server {
    struct server_config config;
    int listener;
    int wake[2]; /* a pipe: written to when the thread is to end */
    struct connection connection[SERVER_CLIENTS_MAX];
    struct modbus_rtu line;
    uint64_t line_rest_ns; /* the other end of the line is gone: not looked at until then */
    uint16_t port;
    pthread_t thread;
    bool is_running;
    atomic_ullong answered;                   /* requests */
    atomic_ullong accepted, refused, dropped; /* connections */
};

/*
 * Opens everything, starts nothing. False: *problem says what the system refuses, until the next
 * call.
 */
bool server_open(struct server *server, const struct server_config *config, const char **problem);
/* The thread. False: the system has none. */
bool server_start(struct server *server);
/* Ends the thread and closes everything. */
void server_close(struct server *server);

/* A socket that listens, without waiting; -1: *problem says why, until the next call. */
int server_listen(const char *address, const char *port, const char **problem);
uint16_t server_port_of(int listener);

uint16_t server_get_port(const struct server *server);

#endif
