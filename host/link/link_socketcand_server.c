/*
 * The server of a socketcand bus: frames of this process go to all clients, and those of a client
 * to this process and to all other clients.
 */
#define _POSIX_C_SOURCE 200809L

#include "link/link_private.h"
#include "link/socketcand.h"
#include "link/stream.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define CLIENTS_MAX (LINK_FDS_MAX - 1) /* one is the listener's */

/*
 * Some clients compare the whole of one read with "< ok >", so nothing may follow it at once. They
 * get frames only so long after it; what comes in between is kept.
 */
#define HOLD_NS 20000000u

#define STALL_NS 1000000000u

enum client_mode { CLIENT_NO_BUS, CLIENT_OPEN, CLIENT_RAW };

struct client {
    struct stream stream; /* fd -1: this place is free */
    enum client_mode mode;
    uint64_t stalled_ns; /* since when there is no room for a frame; 0: there is */
};

struct server {
    int listener;
    char bus[LINK_NAME_MAX + 1];
    struct client client[CLIENTS_MAX];
    unsigned known; /* of them, when departures were counted last */
};

static void drop(struct client *client)
{
    stream_close(&client->stream);
    client->mode = CLIENT_NO_BUS;
}

static void say(struct client *client, const char *text)
{
    if (!stream_write(&client->stream, text, strlen(text)))
        drop(client);
}

static uint64_t real_time_ns(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_REALTIME, &now);
    return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
}

/*
 * A client that is slow is waited for, by refusing to send; one that has not read anything for long
 * is dropped, or it would hold up the bus for ever.
 */
static bool has_room(struct server *server)
{
    uint64_t now_ns = link_clock_ns();
    bool has_room = true;
    for (unsigned i = 0; i < CLIENTS_MAX; i++) {
        struct client *client = &server->client[i];
        if (client->mode != CLIENT_RAW ||
            client->stream.out_used + SOCKETCAND_MESSAGE_MAX <= STREAM_OUT_MAX) {
            client->stalled_ns = 0;
            continue;
        }
        if (client->stalled_ns == 0)
            client->stalled_ns = now_ns;
        if (now_ns - client->stalled_ns > STALL_NS)
            drop(client);
        else
            has_room = false;
    }
    return has_room;
}

/* To all but one. */
static void broadcast(struct server *server, const struct wire_frame *frame,
                      const struct client *but)
{
    char text[SOCKETCAND_MESSAGE_MAX];
    size_t length = 0;
    for (unsigned i = 0; i < CLIENTS_MAX; i++) {
        struct client *client = &server->client[i];
        if (client->mode != CLIENT_RAW || client == but)
            continue;
        if (length == 0)
            length = socketcand_write_frame(text, frame, real_time_ns());
        if (!stream_write(&client->stream, text, length))
            drop(client);
    }
}

static void enter_raw(struct link *link, struct client *client)
{
    client->mode = CLIENT_RAW;
    say(client, "< ok >");
    client->stream.hold_until_ns = link_clock_ns() + HOLD_NS;
    link->wake_ns = client->stream.hold_until_ns;
}

static void take_open(struct server *server, struct client *client, const char *text, size_t length)
{
    char wanted[LINK_NAME_MAX + 8];
    (void)snprintf(wanted, sizeof wanted, "open %s", server->bus);
    if (socketcand_is(text, length, wanted)) {
        client->mode = CLIENT_OPEN;
        say(client, "< ok >");
    } else {
        say(client, "< error could not open bus >");
        drop(client);
    }
}

static void take_message(struct link *link, struct client *client, const char *text, size_t length)
{
    struct wire_frame frame;
    if (client->mode == CLIENT_NO_BUS) {
        take_open(link->state, client, text, length);
    } else if (socketcand_is(text, length, "rawmode")) {
        enter_raw(link, client);
    } else if (socketcand_is(text, length, "echo")) {
        say(client, "< echo >");
    } else if (socketcand_read_send(text, length, &frame)) {
        link_take(link, &frame, 0);
        broadcast(link->state, &frame, client);
    } else {
        link->counts.garbled++;
        say(client, "< error unknown command >");
    }
}

static void take_messages(struct link *link, struct client *client)
{
    struct stream *stream = &client->stream;
    size_t done = 0, begin, length;
    while (stream->fd >= 0 &&
           (length = socketcand_find(stream->in + done, stream->in_used - done, &begin)) > 0) {
        take_message(link, client, stream->in + done + begin, length);
        done += begin + length;
    }
    if (stream->in_used - done > SOCKETCAND_MESSAGE_MAX) {
        link->counts.garbled++;
        done = stream->in_used;
    }
    stream_take(stream, done);
}

static bool server_send(struct link *link, const struct wire_frame *frame)
{
    if (!has_room(link->state))
        return false;
    broadcast(link->state, frame, NULL);
    return true;
}

static unsigned server_prepare(struct link *link, struct pollfd fds[LINK_FDS_MAX])
{
    const struct server *server = link->state;
    fds[CLIENTS_MAX] = (struct pollfd){.fd = server->listener, .events = POLLIN};
    for (unsigned i = 0; i < CLIENTS_MAX; i++) {
        const struct stream *stream = &server->client[i].stream;
        short events = stream_wants_to_write(stream) ? POLLIN | POLLOUT : POLLIN;
        fds[i] = (struct pollfd){.fd = stream->fd, .events = events}; /* -1 is passed over */
    }
    return LINK_FDS_MAX;
}

static void accept_client(struct server *server)
{
    int fd = stream_accept(server->listener);
    for (unsigned i = 0; i < CLIENTS_MAX && fd >= 0; i++) {
        struct client *client = &server->client[i];
        if (client->stream.fd >= 0)
            continue;
        stream_init(&client->stream, fd);
        client->mode = CLIENT_NO_BUS;
        say(client, "< hi >");
        return;
    }
    if (fd >= 0)
        (void)close(fd); /* full */
}

/* What was held back goes out when its time has come; else link_wait is told when. */
static void release_held(struct link *link)
{
    struct server *server = link->state;
    link->wake_ns = 0;
    for (unsigned i = 0; i < CLIENTS_MAX; i++) {
        struct stream *stream = &server->client[i].stream;
        if (stream->fd < 0 || stream->hold_until_ns == 0)
            continue;
        if (!stream_flush(stream))
            drop(&server->client[i]);
        else if (stream->hold_until_ns != 0)
            link->wake_ns = stream->hold_until_ns;
    }
}

static void serve_client(struct link *link, struct client *client, short events)
{
    bool alive = stream_flush(&client->stream);
    if (events & (POLLIN | POLLHUP | POLLERR)) {
        alive = stream_read(&client->stream) && alive;
        take_messages(link, client);
    }
    if (!alive)
        drop(client);
}

static void count_departures(struct link *link)
{
    struct server *server = link->state;
    unsigned present = 0;
    for (unsigned i = 0; i < CLIENTS_MAX; i++)
        present += server->client[i].stream.fd >= 0;
    if (present < server->known)
        link->counts.departures += server->known - present;
    server->known = present;
}

static void server_serve(struct link *link, const struct pollfd *fds, unsigned count)
{
    struct server *server = link->state;
    (void)count;
    count_departures(link);
    for (unsigned i = 0; i < CLIENTS_MAX; i++)
        if (fds[i].revents != 0 && server->client[i].stream.fd >= 0)
            serve_client(link, &server->client[i], fds[i].revents);
    count_departures(link);
    if (fds[CLIENTS_MAX].revents != 0)
        accept_client(server);
    if (link->wake_ns != 0)
        release_held(link);
}

static bool server_has_peer(const struct link *link)
{
    const struct server *server = link->state;
    for (unsigned i = 0; i < CLIENTS_MAX; i++)
        if (server->client[i].mode == CLIENT_RAW)
            return true;
    return false;
}

static bool server_has_pending(const struct link *link)
{
    const struct server *server = link->state;
    for (unsigned i = 0; i < CLIENTS_MAX; i++)
        if (server->client[i].stream.fd >= 0 && server->client[i].stream.out_used > 0)
            return true;
    return false;
}

static void server_close(struct link *link)
{
    struct server *server = link->state;
    for (unsigned i = 0; i < CLIENTS_MAX; i++)
        stream_close(&server->client[i].stream);
    if (server->listener >= 0)
        (void)close(server->listener);
    free(server);
}

static const struct link_kind_ops ops = {
    .send = server_send,
    .prepare = server_prepare,
    .serve = server_serve,
    .has_peer = server_has_peer,
    .has_pending = server_has_pending,
    .close = server_close,
};

bool link_serve_socketcand(struct link *link, const struct link_spec *spec,
                           struct link_error *error)
{
    char address[LINK_NAME_MAX + 1];
    const char *problem = "";
    struct server *server = calloc(1, sizeof *server);
    if (server == NULL)
        return link_refuse(error, "bus %s: out of memory", link->address);
    server->listener = stream_listen(spec->host, spec->port, address, sizeof address, &problem);
    if (server->listener < 0) {
        free(server);
        return link_refuse(error, "bus %s: the port cannot be opened: %s", link->address, problem);
    }
    for (unsigned i = 0; i < CLIENTS_MAX; i++)
        server->client[i].stream.fd = -1;
    (void)snprintf(server->bus, sizeof server->bus, "%s", spec->name);
    (void)snprintf(link->address, sizeof link->address, "%s", address);
    link->ops = &ops;
    link->hears_departures = true;
    link->state = server;
    return true;
}
