/*
 * One client on Modbus TCP: bytes in, requests answered, replies out, without ever waiting.
 */
#ifndef TAKT_SERVE_CONNECTION_H
#define TAKT_SERVE_CONNECTION_H

#include "modbus/tcp.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define CONNECTION_INPUT_MAX 1024

/* Requests answered at a time, before others have their turn. */
#define CONNECTION_TURN 4

struct connection {
    int socket;            /* -1: free */
    struct modbus_map map; /* what it talks to */
    struct modbus_tcp frame;
    uint8_t input[CONNECTION_INPUT_MAX];
    size_t input_at, input_size; /* not used yet: from input_at, input_size bytes */
    uint8_t output[MODBUS_TCP_MAX];
    size_t output_at, output_size; /* not sent yet */
    uint64_t served_ns;            /* when its last request was answered, or it came */
    uint64_t begun_ns; /* when the first byte of the request on its way came; 0: none has */
};

void connection_open(struct connection *connection, int socket, const struct modbus_map *map,
                     uint64_t now_ns);
void connection_close(struct connection *connection);

/*
 * There is something to do: bytes have come (readable), or may be sent. Adds to *answered. False:
 * it is to be closed.
 */
bool connection_serve(struct connection *connection, bool readable, uint64_t now_ns,
                      uint64_t *answered);

/* It has a reply to send, and does not read before. */
bool connection_is_sending(const struct connection *connection);

/* Whole requests may lie there unanswered: it wants another turn without new bytes. */
bool connection_is_waiting(const struct connection *connection);

#endif
