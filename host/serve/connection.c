#define _POSIX_C_SOURCE 200809L

#include "serve/connection.h"

#include <errno.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

void connection_open(struct connection *connection, int socket, const struct modbus_map *map,
                     uint64_t now_ns)
{
    memset(connection, 0, sizeof *connection);
    connection->socket = socket;
    connection->served_ns = now_ns;
    connection->map = *map;
    takt_modbus_tcp_init(&connection->frame);
}

void connection_close(struct connection *connection)
{
    (void)close(connection->socket);
    connection->socket = -1;
}

bool connection_is_sending(const struct connection *connection)
{
    return connection->output_size > 0;
}

bool connection_is_waiting(const struct connection *connection)
{
    return connection->input_size > 0 && !connection_is_sending(connection);
}

static bool is_for_later(void)
{
    return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
}

static bool send_reply(struct connection *c)
{
    const ssize_t sent =
        send(c->socket, c->output + c->output_at, c->output_size, MSG_NOSIGNAL | MSG_DONTWAIT);

    if (sent < 0)
        return is_for_later();
    c->output_at += (size_t)sent;
    c->output_size -= (size_t)sent;
    return true;
}

static bool receive(struct connection *c, uint64_t now_ns)
{
    ssize_t received;

    if (c->input_size > 0)
        return true;
    received = recv(c->socket, c->input, sizeof c->input, MSG_DONTWAIT);
    if (received < 0)
        return is_for_later();
    c->input_at = 0;
    c->input_size = (size_t)received;
    if (received > 0 && c->begun_ns == 0)
        c->begun_ns = now_ns;
    return received > 0;
}

/* The next request in the input. False: the stream makes no sense. */
static bool answer(struct connection *c, uint64_t now_ns, uint64_t *answered)
{
    const uint8_t *data = c->input + c->input_at;
    size_t length = 0;

    switch (takt_modbus_tcp_take(&c->frame, &c->map, &data, &c->input_size, c->output, &length)) {
    case MODBUS_TCP_MORE:
        break;
    case MODBUS_TCP_REPLY:
        (*answered)++;
        c->served_ns = now_ns;
        c->begun_ns = c->input_size > 0 ? now_ns : 0;
        c->output_at = 0;
        c->output_size = length;
        break;
    case MODBUS_TCP_BROKEN:
        return false;
    }
    c->input_at = (size_t)(data - c->input);
    return true;
}

bool connection_serve(struct connection *connection, bool readable, uint64_t now_ns,
                      uint64_t *answered)
{
    if (connection_is_sending(connection) && !send_reply(connection))
        return false;
    if (readable && !connection_is_sending(connection) && !receive(connection, now_ns))
        return false;
    for (unsigned turn = 0; turn < CONNECTION_TURN && connection_is_waiting(connection); turn++) {
        if (!answer(connection, now_ns, answered) ||
            (connection_is_sending(connection) && !send_reply(connection)))
            return false;
    }
    return true;
}
