/*
 * SLCAN over a serial port, a pseudo-terminal or TCP, as the computer or as the adapter.
 *
 * As the adapter it answers commands as such devices do and is generous: whatever is asked twice is
 * granted twice. While no computer has opened the channel, frames vanish as on a bus that nobody
 * listens to.
 */
#define _DEFAULT_SOURCE

#include "link/link_private.h"
#include "link/slcan.h"
#include "link/stream.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <unistd.h>

struct slcan_link {
    struct stream peer;
    int listener;  /* -1: none */
    int other_end; /* of our own pty, held while no computer has opened the channel; -1: not held */
    bool is_pty;
    bool is_adapter;
    bool channel_open;
    char symlink[LINK_NAME_MAX + 1];
};

static void reply(struct slcan_link *s, const char *text)
{
    (void)stream_write(&s->peer, text, strlen(text)); /* who does not read gets no answer */
}

/* A pty whose other end nobody holds can only be read from its end on. */
static void hold_pty(struct link *link)
{
    struct slcan_link *s = link->state;
    if (!s->is_pty)
        return;
    if (s->other_end < 0)
        s->other_end = stream_hold_pty(link->address);
    if (s->other_end < 0)
        link_fail(link, "bus %s: the pseudo-terminal cannot be opened again: %s", link->address,
                  strerror(errno));
    else
        (void)tcflush(s->other_end, TCIFLUSH);
}

/* So that it is heard when the computer's program ends, however it does. */
static void let_pty_go(struct slcan_link *s)
{
    if (s->other_end >= 0)
        (void)close(s->other_end);
    s->other_end = -1;
}

/* What nobody has read is not for the next one. */
static void close_channel(struct link *link)
{
    struct slcan_link *s = link->state;
    if (s->is_pty && s->channel_open)
        link->counts.departures++;
    s->channel_open = false;
    s->peer.out_used = 0;
    hold_pty(link);
}

static void open_channel(struct slcan_link *s)
{
    s->channel_open = true;
    let_pty_go(s);
    reply(s, "\r");
}

static void take_frame(struct link *link, const char *line, size_t length)
{
    struct slcan_link *s = link->state;
    struct wire_frame frame;
    if (slcan_read(line, length, &frame)) {
        if (s->is_adapter)
            reply(s, frame.flags & WIRE_EXTENDED ? "Z\r" : "z\r");
        if (s->channel_open)
            link_take(link, &frame, 0);
        return;
    }
    link->counts.garbled++;
    if (s->is_adapter)
        reply(s, "\a");
}

static void take_command(struct link *link, const char *line, size_t length)
{
    struct slcan_link *s = link->state;
    switch (length > 0 ? line[0] : '\0') {
    case 'O':
    case 'L':
        open_channel(s);
        break;
    case 'C':
        close_channel(link);
        reply(s, "\r");
        break;
    case 'V':
        reply(s, "V1010\r");
        break;
    case 'N':
        reply(s, "NTAKT\r");
        break;
    case 'F':
        reply(s, "F00\r");
        break;
    case 't':
    case 'T':
    case 'r':
    case 'R':
    case 'd':
    case 'D':
    case 'b':
    case 'B':
        take_frame(link, line, length);
        break;
    default: /* bit rates, filters, time stamps: nothing depends on them here */
        reply(s, "\r");
        break;
    }
}

/*
 * An adapter's answers to commands are of no interest: what does not begin as a frame is passed
 * over.
 */
static void take_line(struct link *link, const char *line, size_t length)
{
    const struct slcan_link *s = link->state;
    if (s->is_adapter)
        take_command(link, line, length);
    else if (length > 1 && strchr("tTrRdDbB", line[0]) != NULL)
        take_frame(link, line, length);
}

static bool is_line_end(char c)
{
    return c == '\r' || c == '\n' || c == '\a';
}

static void take_lines(struct link *link)
{
    struct slcan_link *s = link->state;
    size_t begin = 0;
    for (size_t i = 0; i < s->peer.in_used; i++) {
        if (!is_line_end(s->peer.in[i]))
            continue;
        if (s->peer.in[i] != '\n' || i > begin)
            take_line(link, s->peer.in + begin, i - begin);
        begin = i + 1;
    }
    if (s->peer.in_used - begin > SLCAN_LINE_MAX) { /* no line is as long as that */
        link->counts.garbled++;
        begin = s->peer.in_used;
    }
    stream_take(&s->peer, begin);
}

/* A listener and a pty wait for the next one; everybody else has lost the bus. */
static void lose_peer(struct link *link)
{
    struct slcan_link *s = link->state;
    if (s->is_pty) {
        s->peer.in_used = 0;
        close_channel(link);
        return;
    }
    stream_close(&s->peer);
    link->counts.departures++;
    if (s->listener >= 0)
        s->channel_open = false;
    else
        link_fail(link, "bus %s: the other side has closed the connection", link->address);
}

static bool slcan_send(struct link *link, const struct wire_frame *frame)
{
    struct slcan_link *s = link->state;
    char line[SLCAN_LINE_MAX];
    if (!s->channel_open)
        return true;
    if (stream_write(&s->peer, line, slcan_write(line, frame)))
        return true;
    if (!s->is_adapter)
        return false;
    close_channel(link); /* its computer has stopped reading */
    return true;
}

static unsigned slcan_prepare(struct link *link, struct pollfd fds[LINK_FDS_MAX])
{
    const struct slcan_link *s = link->state;
    if (s->peer.fd < 0) {
        fds[0] = (struct pollfd){.fd = s->listener, .events = POLLIN};
        return 1;
    }
    short events = stream_wants_to_write(&s->peer) ? POLLIN | POLLOUT : POLLIN;
    fds[0] = (struct pollfd){.fd = s->peer.fd, .events = events};
    return 1;
}

static void accept_peer(struct slcan_link *s)
{
    int fd = stream_accept(s->listener);
    if (fd >= 0)
        stream_init(&s->peer, fd);
}

static void slcan_serve(struct link *link, const struct pollfd *fds, unsigned count)
{
    struct slcan_link *s = link->state;
    (void)count;
    if (fds[0].revents == 0)
        return;
    if (s->peer.fd < 0) {
        accept_peer(s);
        return;
    }
    bool alive = stream_flush(&s->peer);
    if (fds[0].revents & (POLLIN | POLLHUP | POLLERR)) {
        alive = stream_read(&s->peer) && alive;
        take_lines(link);
    }
    if (!alive)
        lose_peer(link);
}

static bool slcan_has_peer(const struct link *link)
{
    const struct slcan_link *s = link->state;
    return s->channel_open;
}

static bool slcan_has_pending(const struct link *link)
{
    const struct slcan_link *s = link->state;
    return s->peer.fd >= 0 && s->peer.out_used > 0;
}

static void slcan_close(struct link *link)
{
    struct slcan_link *s = link->state;
    if (!s->is_adapter && s->peer.fd >= 0)
        reply(s, "C\r");
    stream_close(&s->peer);
    if (s->listener >= 0)
        (void)close(s->listener);
    let_pty_go(s);
    if (s->symlink[0] != '\0')
        (void)unlink(s->symlink);
    free(s);
}

static const struct link_kind_ops ops = {
    .send = slcan_send,
    .prepare = slcan_prepare,
    .serve = slcan_serve,
    .has_peer = slcan_has_peer,
    .has_pending = slcan_has_pending,
    .close = slcan_close,
};

#define MEGABIT        1000000u
#define DATA_MBIT_MAX  9u
#define DATA_MBIT_ELSE 5u

/* "Y5\r": data of CAN FD at 5 Mbit/s. False: there is no digit for the rate. */
static bool write_data_rate(const struct link *link, char text[8])
{
    const uint32_t given = link->config.data_bitrate;
    const unsigned mbit = given > 0 ? given / MEGABIT : DATA_MBIT_ELSE;
    text[0] = '\0';
    if (link->config.fd)
        (void)snprintf(text, 8, "Y%u\r", mbit % 10);
    return !link->config.fd || (given % MEGABIT == 0 && mbit <= DATA_MBIT_MAX);
}

static bool refuse_rate(const struct link *link, const char *what, uint32_t rate, const char *known,
                        struct link_error *error)
{
    (void)link_refuse(error, "bus %s: serial adapters know no %s %u bit/s; they know %s",
                      link->address, what, (unsigned)rate, known);
    error->is_environment = false;
    return false;
}

/*
 * An adapter that was left open is closed first; the carriage returns end whatever it had got half
 * of.
 */
static bool greet_adapter(struct link *link, struct slcan_link *s, struct link_error *error)
{
    char hello[32], data_rate[8];
    char digit = slcan_bitrate_digit(link->config.bitrate);
    if (digit == 0)
        return refuse_rate(link, "bit rate", link->config.bitrate,
                           "10000, 20000, 50000, 100000, 125000, 250000, 500000, 800000 and "
                           "1000000",
                           error);
    if (!write_data_rate(link, data_rate))
        return refuse_rate(link, "data rate", link->config.data_bitrate,
                           "1000000 to 9000000 in whole millions", error);
    (void)snprintf(hello, sizeof hello, "\r\rC\rS%c\r%sO\r", digit, data_rate);
    reply(s, hello);
    s->channel_open = true;
    return true;
}

static bool open_device(struct link *link, const struct link_spec *spec, struct link_error *error)
{
    struct slcan_link *s = link->state;
    int fd = stream_open_serial(spec->name, spec->baud);
    if (fd < 0)
        return link_refuse(error, "bus %s: %s cannot be used: %s", link->address, spec->name,
                           strerror(errno));
    stream_init(&s->peer, fd);
    return greet_adapter(link, s, error);
}

static bool open_connection(struct link *link, const struct link_spec *spec,
                            struct link_error *error)
{
    struct slcan_link *s = link->state;
    const char *problem = "";
    int fd = stream_connect(spec->host, spec->port, LINK_CONNECT_MS, &problem);
    if (fd < 0)
        return link_refuse(error, "bus %s: no connection: %s", link->address, problem);
    stream_init(&s->peer, fd);
    return greet_adapter(link, s, error);
}

static bool make_symlink(struct slcan_link *s, const char *to, const char *name)
{
    if (name[0] == '\0')
        return true;
    if (symlink(to, name) != 0)
        return false;
    (void)snprintf(s->symlink, sizeof s->symlink, "%s", name);
    return true;
}

static bool open_pty(struct link *link, const struct link_spec *spec, struct link_error *error)
{
    struct slcan_link *s = link->state;
    char name[LINK_NAME_MAX + 1];
    int fd = stream_open_pty(name, sizeof name, &s->other_end);
    if (fd < 0)
        return link_refuse(error, "bus %s: no pseudo-terminal can be made: %s", link->address,
                           strerror(errno));
    stream_init(&s->peer, fd);
    s->is_adapter = s->is_pty = true;
    link->hears_departures = true;
    if (!make_symlink(s, name, spec->name))
        return link_refuse(error, "bus %s: the link %s cannot be made: %s", link->address,
                           spec->name, strerror(errno));
    (void)snprintf(link->address, sizeof link->address, "%s", name);
    return true;
}

static bool open_listener(struct link *link, const struct link_spec *spec, struct link_error *error)
{
    struct slcan_link *s = link->state;
    char address[LINK_NAME_MAX + 1];
    const char *problem = "";
    s->listener = stream_listen(spec->host, spec->port, address, sizeof address, &problem);
    if (s->listener < 0)
        return link_refuse(error, "bus %s: the port cannot be opened: %s", link->address, problem);
    s->is_adapter = true;
    link->hears_departures = true;
    (void)snprintf(link->address, sizeof link->address, "%s", address);
    return true;
}

static bool open_way(struct link *link, const struct link_spec *spec, struct link_error *error)
{
    switch (spec->way) {
    case LINK_WAY_DEVICE:
        return open_device(link, spec, error);
    case LINK_WAY_PTY:
        return open_pty(link, spec, error);
    case LINK_WAY_LISTEN:
        return open_listener(link, spec, error);
    case LINK_WAY_CONNECT:
    case LINK_WAY_NONE:
        break;
    }
    return open_connection(link, spec, error);
}

bool link_open_slcan(struct link *link, const struct link_spec *spec, struct link_error *error)
{
    struct slcan_link *s = calloc(1, sizeof *s);
    if (s == NULL)
        return link_refuse(error, "bus %s: out of memory", link->address);
    s->peer.fd = s->listener = s->other_end = -1;
    link->ops = &ops;
    link->state = s;
    if (open_way(link, spec, error))
        return true;
    slcan_close(link);
    return false;
}
