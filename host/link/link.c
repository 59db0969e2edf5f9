#define _GNU_SOURCE

#include "link/link_private.h"

#include <assert.h>
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static_assert((LINK_QUEUE_MAX & (LINK_QUEUE_MAX - 1)) == 0, "queue indices are masked");

#define SECOND_NS 1000000000u

static uint64_t read_clock(clockid_t clock)
{
    struct timespec now;
    (void)clock_gettime(clock, &now);
    return (uint64_t)now.tv_sec * SECOND_NS + (uint64_t)now.tv_nsec;
}

uint64_t link_clock_ns(void)
{
    return read_clock(CLOCK_MONOTONIC);
}

static void observe(const struct link *link, const struct wire_frame *frame, uint64_t time_ns)
{
    if (link->observer.on_frame)
        link->observer.on_frame(link->observer.context, frame,
                                time_ns ? time_ns : read_clock(CLOCK_REALTIME));
}

void link_take(struct link *link, const struct wire_frame *frame, uint64_t time_ns)
{
    observe(link, frame, time_ns);
    if (frame->flags & WIRE_ERROR) {
        link->counts.error_frames++;
        return;
    }
    link->counts.received++;
    if (link->written - link->read == LINK_QUEUE_MAX) {
        link->counts.receive_lost++;
        return;
    }
    link->queue[link->written++ & (LINK_QUEUE_MAX - 1)] = *frame;
}

void link_fail(struct link *link, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(link->problem, sizeof link->problem, format, arguments);
    va_end(arguments);
    link->broken = true;
}

bool link_refuse(struct link_error *error, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(error->text, sizeof error->text, format, arguments);
    va_end(arguments);
    error->is_environment = true;
    return false;
}

bool link_check(const char *spec, enum link_kind *kind, struct link_error *error)
{
    struct link_spec parts;
    if (!link_spec_read(spec, &parts, error))
        return false;
    *kind = parts.kind;
    return true;
}

static bool open_kind(struct link *link, const struct link_spec *spec, struct link_error *error)
{
    switch (spec->kind) {
    case LINK_SOCKETCAN:
        return link_open_socketcan(link, spec, error);
    case LINK_SLCAN:
        return link_open_slcan(link, spec, error);
    case LINK_SOCKETCAND:
        return spec->way == LINK_WAY_LISTEN ? link_serve_socketcand(link, spec, error)
                                            : link_open_socketcand(link, spec, error);
    case LINK_EMBEDDED:
        break;
    }
    (void)link_refuse(error, "bus embedded: it is inside one process; here a bus is needed that "
                             "others can reach, such as slcan:pty or socketcan:vcan0");
    error->is_environment = false;
    return false;
}

struct link *link_open(const char *spec, const struct link_config *config, struct link_error *error)
{
    struct link_spec parts;
    struct link *link;
    if (!link_spec_read(spec, &parts, error))
        return NULL;
    link = calloc(1, sizeof *link);
    if (link == NULL) {
        (void)link_refuse(error, "bus %s: out of memory", spec);
        return NULL;
    }
    link->config = *config;
    link->config.fd = config->fd || config->data_bitrate > 0;
    (void)snprintf(link->address, sizeof link->address, "%s", spec);
    if (open_kind(link, &parts, error))
        return link;
    free(link);
    return NULL;
}

void link_close(struct link *link)
{
    if (link == NULL)
        return;
    link->ops->close(link);
    free(link);
}

bool link_send(struct link *link, const struct wire_frame *frame)
{
    if (link->broken || !link->ops->send(link, frame)) {
        link->counts.refused++;
        return false;
    }
    link->counts.sent++;
    observe(link, frame, 0);
    return true;
}

static struct timespec time_until(uint64_t time_ns)
{
    uint64_t now_ns = link_clock_ns();
    uint64_t left_ns = time_ns > now_ns ? time_ns - now_ns : 0;
    return (struct timespec){.tv_sec = (time_t)(left_ns / SECOND_NS),
                             .tv_nsec = (long)(left_ns % SECOND_NS)};
}

/* One look at everything that may have come; waits until until_ns at most. False: a signal came. */
static bool look(struct link *link, uint64_t until_ns)
{
    struct pollfd fds[LINK_FDS_MAX];
    unsigned count = link->ops->prepare(link, fds);
    struct timespec left = time_until(until_ns);
    if (ppoll(fds, count, &left, NULL) < 0)
        return errno != EINTR;
    link->ops->serve(link, fds, count);
    return true;
}

static bool is_empty(const struct link *link)
{
    return link->read == link->written;
}

bool link_receive(struct link *link, struct wire_frame *frame)
{
    if (is_empty(link) && !link->broken)
        (void)look(link, 0);
    if (is_empty(link))
        return false;
    *frame = link->queue[link->read++ & (LINK_QUEUE_MAX - 1)];
    return true;
}

enum link_wait_result link_wait(struct link *link, uint64_t until_ns)
{
    bool goes_on = true;
    while (is_empty(link) && !link->broken) {
        if (!goes_on)
            return LINK_TIMEOUT;
        uint64_t wake_ns = link->wake_ns && link->wake_ns < until_ns ? link->wake_ns : until_ns;
        goes_on = look(link, wake_ns) && link_clock_ns() < until_ns;
    }
    return is_empty(link) ? LINK_BROKEN : LINK_READY;
}

bool link_flush(struct link *link, uint64_t until_ns)
{
    while (link->ops->has_pending(link) && !link->broken) {
        if (link_clock_ns() >= until_ns)
            return false;
        (void)look(link, link->wake_ns && link->wake_ns < until_ns ? link->wake_ns : until_ns);
    }
    return !link->broken;
}

/*
 * A frame for a bus that has gone is lost, and not refused: it is link_wait that tells the loss,
 * also when sending is first to meet it.
 */
static bool port_send(void *context, const struct can_frame *frame)
{
    struct wire_frame wire;
    struct link *link = context;
    wire_frame_from_can(&wire, frame, link->config.data_bitrate > 0);
    if (link_send(link, &wire))
        return true;
    if (!link->broken)
        (void)look(link, 0);
    return link->broken;
}

static bool port_receive(void *context, struct can_frame *frame)
{
    const uint8_t kind = ((const struct link *)context)->config.data_bitrate > 0 ? WIRE_FD : 0;
    struct wire_frame wire;
    while (link_receive(context, &wire)) {
        const uint8_t others = wire.flags & WIRE_REMOTE ? 0 : WIRE_FD & ~kind;
        if (!(wire.flags & others) && wire_frame_to_can(&wire, frame))
            return true;
    }
    return false;
}

struct can_port link_get_port(struct link *link)
{
    return (struct can_port){.send = port_send, .receive = port_receive, .context = link};
}

void link_observe(struct link *link, const struct wire_listener *listener)
{
    link->observer = listener ? *listener : (struct wire_listener){0};
}

const char *link_get_address(const struct link *link)
{
    return link->address;
}

bool link_has_peer(const struct link *link)
{
    return link->ops->has_peer(link);
}

bool link_hears_departures(const struct link *link)
{
    return link->hears_departures;
}

const char *link_get_problem(const struct link *link)
{
    return link->problem;
}

const struct link_counts *link_get_counts(const struct link *link)
{
    return &link->counts;
}
