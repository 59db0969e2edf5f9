/*
 * Modbus TCP frames out of a stream of bytes, one connection.
 *
 *     transaction (2 bytes), protocol 0 (2), length of what follows (2), unit, PDU
 *
 * A stream cannot be resynchronised: after a header that makes no sense the connection is to be
 * closed.
 */
#ifndef TAKT_MODBUS_TCP_H
#define TAKT_MODBUS_TCP_H

#include "modbus/modbus.h"

#define MODBUS_TCP_HEADER 7
#define MODBUS_TCP_MAX    (MODBUS_TCP_HEADER + MODBUS_PDU_MAX)

enum modbus_tcp_result {
    MODBUS_TCP_MORE,  /* all bytes are used; no whole frame yet */
    MODBUS_TCP_REPLY, /* a request is answered; there may be bytes left */
    MODBUS_TCP_BROKEN /* close the connection */
};

struct modbus_tcp {
    size_t length;
    uint8_t frame[MODBUS_TCP_MAX];
};

/* A new connection. */
void takt_modbus_tcp_init(struct modbus_tcp *tcp);

/*
 * Takes bytes from *data, *size of them, and moves both on, up to the end of a request:
 * MODBUS_TCP_REPLY, the reply is in reply[MODBUS_TCP_MAX], *reply_length bytes. Any unit is
 * answered, as itself.
 */
enum modbus_tcp_result takt_modbus_tcp_take(struct modbus_tcp *tcp, const struct modbus_map *map,
                                            const uint8_t **data, size_t *size, uint8_t *reply,
                                            size_t *reply_length);

#endif
