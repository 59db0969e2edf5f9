/*
 * A bus of a socketcand server, as its client.
 */
#define _POSIX_C_SOURCE 200809L

#include "link/link_private.h"
#include "link/socketcand.h"
#include "link/stream.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void take_message(struct link *link, const char *text, size_t length)
{
    struct wire_frame frame;
    if (socketcand_read_frame(text, length, &frame)) {
        link_take(link, &frame, 0);
    } else if (length > 8 && memcmp(text, "< error ", 8) == 0) {
        frame = (struct wire_frame){.flags = WIRE_ERROR};
        link_take(link, &frame, 0);
    } else {
        link->counts.garbled++;
    }
}

static void take_messages(struct link *link, struct stream *server)
{
    size_t done = 0, begin, length;
    while ((length = socketcand_find(server->in + done, server->in_used - done, &begin)) > 0) {
        take_message(link, server->in + done + begin, length);
        done += begin + length;
    }
    if (server->in_used - done > SOCKETCAND_MESSAGE_MAX) { /* no message is as long as that */
        link->counts.garbled++;
        done = server->in_used;
    }
    stream_take(server, done);
}

static bool client_send(struct link *link, const struct wire_frame *frame)
{
    char text[SOCKETCAND_MESSAGE_MAX];
    return stream_write(link->state, text, socketcand_write_send(text, frame));
}

static unsigned client_prepare(struct link *link, struct pollfd fds[LINK_FDS_MAX])
{
    const struct stream *server = link->state;
    short events = stream_wants_to_write(server) ? POLLIN | POLLOUT : POLLIN;
    fds[0] = (struct pollfd){.fd = server->fd, .events = events};
    return 1;
}

static void client_serve(struct link *link, const struct pollfd *fds, unsigned count)
{
    struct stream *server = link->state;
    (void)count;
    if (fds[0].revents == 0)
        return;
    bool alive = stream_flush(server);
    if (fds[0].revents & (POLLIN | POLLHUP | POLLERR)) {
        alive = stream_read(server) && alive;
        take_messages(link, server);
    }
    if (!alive)
        link_fail(link, "bus %s: the server has closed the connection", link->address);
}

static bool client_has_peer(const struct link *link)
{
    return !link->broken;
}

static bool client_has_pending(const struct link *link)
{
    const struct stream *server = link->state;
    return server->out_used > 0;
}

static void client_close(struct link *link)
{
    stream_close(link->state);
    free(link->state);
}

static const struct link_kind_ops ops = {
    .send = client_send,
    .prepare = client_prepare,
    .serve = client_serve,
    .has_peer = client_has_peer,
    .has_pending = client_has_pending,
    .close = client_close,
};

static int milliseconds_left(uint64_t until_ns)
{
    uint64_t now_ns = link_clock_ns();
    return now_ns < until_ns ? (int)((until_ns - now_ns) / 1000000 + 1) : 0;
}

/* Waits for one whole message, which may not be of frames yet. False: none came, or another. */
static bool expect(struct stream *server, const char *words, uint64_t until_ns)
{
    struct pollfd wait = {.fd = server->fd, .events = POLLIN};
    size_t begin, length;
    while ((length = socketcand_find(server->in, server->in_used, &begin)) == 0) {
        if (poll(&wait, 1, milliseconds_left(until_ns)) != 1 || !stream_read(server))
            return false;
    }
    bool is_it = socketcand_is(server->in + begin, length, words);
    stream_take(server, begin + length);
    return is_it;
}

static bool say(struct stream *server, const char *text)
{
    return stream_write(server, text, strlen(text));
}

static bool shake_hands(struct link *link, const struct link_spec *spec, struct link_error *error)
{
    struct stream *server = link->state;
    uint64_t until_ns = link_clock_ns() + LINK_CONNECT_MS * 1000000ull;
    char open[LINK_NAME_MAX + 16];
    (void)snprintf(open, sizeof open, "< open %s >", spec->name);
    if (!expect(server, "hi", until_ns))
        return link_refuse(error, "bus %s: no socketcand server answers there", link->address);
    if (!say(server, open) || !expect(server, "ok", until_ns))
        return link_refuse(error, "bus %s: the server has no bus %s", link->address, spec->name);
    if (!say(server, "< rawmode >") || !expect(server, "ok", until_ns))
        return link_refuse(error, "bus %s: the server does not offer raw frames", link->address);
    return true;
}

bool link_open_socketcand(struct link *link, const struct link_spec *spec, struct link_error *error)
{
    const char *problem = "";
    struct stream *server = calloc(1, sizeof *server);
    int fd;
    if (server == NULL)
        return link_refuse(error, "bus %s: out of memory", link->address);
    fd = stream_connect(spec->host, spec->port, LINK_CONNECT_MS, &problem);
    if (fd < 0) {
        free(server);
        return link_refuse(error, "bus %s: no connection: %s", link->address, problem);
    }
    stream_init(server, fd);
    link->ops = &ops;
    link->state = server;
    if (shake_hands(link, spec, error))
        return true;
    client_close(link);
    return false;
}
