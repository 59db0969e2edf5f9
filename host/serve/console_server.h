/*
 * The console behind a socket or a pseudo terminal: one sender at a time, in a thread of its own.
 */
#ifndef TAKT_SERVE_CONSOLE_SERVER_H
#define TAKT_SERVE_CONSOLE_SERVER_H

#include "console/console.h"
#include "serve/allow_list.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Text on its way to the program, and answers on their way to the sender. Bytes. */
#define CONSOLE_SERVER_TEXT   2048
#define CONSOLE_SERVER_OUTPUT 65536

#define CONSOLE_SERVER_PATH_MAX 255

struct console_server_config {
    const char *address; /* "127.0.0.1"; NULL: a pseudo terminal */
    const char *port;
    const char *link; /* a symbolic link to it */
    struct allow_list allowed;
    struct console_config console; /* without lines; its write is not used */
    /* A sender has come, or is gone. */
    void (*enter)(void *context);
    void (*leave)(void *context);
    void *context;
};

/* It must not be moved once opened. */
struct console_server {
    struct console_server_config config;
    struct console console;
    struct console_port port; /* the console's own behind its write */
    struct lines lines;
    uint8_t text[CONSOLE_SERVER_TEXT];
    char output[CONSOLE_SERVER_OUTPUT];
    size_t output_size;
    int listener;   /* of TCP; -1 */
    int terminal;   /* the master of a pseudo terminal; -1 */
    int sender;     /* whoever is there; -1: nobody */
    int wake[2];    /* a pipe: written to when the thread is to end */
    bool overflows; /* the sender does not read */
    pthread_t thread;
    bool is_running;
    atomic_ullong lines_taken, senders;
};

/* Opens everything, starts nothing. False: *problem says why, until the next call. */
bool console_server_open(struct console_server *s, const struct console_server_config *config,
                         const char **problem);
bool console_server_start(struct console_server *s);
void console_server_close(struct console_server *s);

/* Its port of TCP. */
uint16_t console_server_get_port(const struct console_server *s);

#endif
