/*
 * The way back to a bus that is gone: it is opened again and again, in a thread of its own, since a
 * server that does not answer takes seconds. Between two attempts lies twice the time of the one
 * before, up to BUS_RETURN_LONGEST_NS.
 */
#ifndef TAKT_HOST_BUS_RETURN_H
#define TAKT_HOST_BUS_RETURN_H

#include "link/link.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#define BUS_RETURN_FIRST_NS   UINT64_C(100000000)
#define BUS_RETURN_LONGEST_NS UINT64_C(5000000000)

/* It must not be moved while it is looking. Private. */
struct bus_return {
    const char *spec; /* the caller's */
    struct link_config config;
    bool is_looking;
    bool is_trying; /* the thread has been started and not joined */
    atomic_bool has_tried;
    pthread_t thread;
    struct link *link; /* of the thread, until it has tried; NULL: not opened */
    uint64_t next_ns;  /* when the next attempt is due, by link_clock_ns */
    uint64_t pause_ns; /* and how long after the last */
};

void bus_return_init(struct bus_return *way, const char *spec, const struct link_config *config);

/*
 * Now and again, with the time of link_clock_ns: the bus once it is open, the caller's from then
 * on. NULL: not yet.
 */
struct link *bus_return_look(struct bus_return *way, uint64_t now_ns);

/* Gives it up; waits for an attempt that is under way. */
void bus_return_stop(struct bus_return *way);

#endif
