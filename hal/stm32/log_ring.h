/*
 * Lines of the log on their way to a serial line. What finds no room is left out as a whole line.
 */
#ifndef TAKT_STM32_LOG_RING_H
#define TAKT_STM32_LOG_RING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define LOG_RING_MAX 1024 /* a power of two */

struct log_ring {
    uint32_t written, taken; /* bytes so far, wrapping */
    uint32_t given;    /* of those that are not taken: by the last call of takt_log_ring_take */
    uint32_t left_out; /* lines */
    uint8_t byte[LOG_RING_MAX];
};

/* A line without its end; it is given one. False: no room. */
bool takt_log_ring_put(struct log_ring *ring, const char *line);

/*
 * Gives up to most bytes, the oldest first; returns how many. *bytes: where they stand, until the
 * next call. Those behind the end of the ring come with the next call.
 */
size_t takt_log_ring_take(struct log_ring *ring, const uint8_t **bytes, size_t most);

#endif
