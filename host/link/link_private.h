/*
 * Shared by the sources of link.h: what all kinds of outside buses have in common.
 */
#ifndef TAKT_HOST_LINK_PRIVATE_H
#define TAKT_HOST_LINK_PRIVATE_H

#include "link/link.h"
#include "link/link_spec.h"

#include <poll.h>

#define LINK_QUEUE_MAX  4096 /* frames received and not taken yet, a power of two */
#define LINK_FDS_MAX    10   /* file descriptors a kind waits for at most */
#define LINK_CONNECT_MS 5000 /* for a server to answer */

/* What a kind of bus does. None of them may wait. */
struct link_kind_ops {
    /* Sends or queues. False: no room. */
    bool (*send)(struct link *link, const struct wire_frame *frame);
    /* Fills in what to wait for; returns the number. */
    unsigned (*prepare)(struct link *link, struct pollfd fds[LINK_FDS_MAX]);
    /*
     * Serves what poll has found: link_take for each frame that came, link_fail when the bus is
     * gone.
     */
    void (*serve)(struct link *link, const struct pollfd *fds, unsigned count);
    bool (*has_peer)(const struct link *link);
    bool (*has_pending)(const struct link *link); /* something has been queued and not sent */
    void (*close)(struct link *link);
};

struct link {
    const struct link_kind_ops *ops;
    void *state; /* of the kind */
    struct link_config config;
    struct link_counts counts;
    struct wire_listener observer;
    bool broken;
    bool hears_departures; /* peers that go are counted */
    uint64_t wake_ns; /* link_wait looks again at this time, though nothing comes; 0: no need */
    char address[LINK_NAME_MAX + 1];
    char problem[LINK_ERROR_MAX + 1];
    unsigned read, written; /* count up; index modulo LINK_QUEUE_MAX */
    struct wire_frame queue[LINK_QUEUE_MAX];
};

/* A frame has come. time_ns: when, since 1970; 0: now. */
void link_take(struct link *link, const struct wire_frame *frame, uint64_t time_ns);
void link_fail(struct link *link, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* For opening functions: fills *error for the environment and returns false. */
bool link_refuse(struct link_error *error, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Each opens its kind into a link whose config is set, and sets ops, state and address. */
bool link_open_socketcan(struct link *link, const struct link_spec *spec, struct link_error *error);
bool link_open_slcan(struct link *link, const struct link_spec *spec, struct link_error *error);
bool link_open_socketcand(struct link *link, const struct link_spec *spec,
                          struct link_error *error);
bool link_serve_socketcand(struct link *link, const struct link_spec *spec,
                           struct link_error *error);

#endif
