/*
 * Frames of every kind a bus may carry, at random, for the tests of buses and of their text forms.
 */
#ifndef TAKT_TESTS_RANDOM_FRAME_H
#define TAKT_TESTS_RANDOM_FRAME_H

#include "bus/wire_frame.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#define RANDOM_FRAME_STANDARD_IDS 0x800u
#define RANDOM_FRAME_EXTENDED_IDS 0x20000000u

/* Below range. */
static inline uint32_t random_below(uint64_t *state, uint32_t range)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(*state >> 33) % range;
}

/* A third of them CAN FD, a sixth without data that asks for an answer. */
static inline struct wire_frame random_frame(uint64_t *state)
{
    struct wire_frame frame = {.flags = random_below(state, 2) ? WIRE_EXTENDED : 0};

    frame.id =
        random_below(state, frame.flags ? RANDOM_FRAME_EXTENDED_IDS : RANDOM_FRAME_STANDARD_IDS);
    frame.length = (uint8_t)random_below(state, 9);
    if (random_below(state, 3) == 0) {
        frame.flags |= random_below(state, 2) ? WIRE_FD : WIRE_FD | WIRE_RATE_SWITCH;
        frame.length = wire_frame_fd_length(random_below(state, WIRE_DATA_MAX + 1));
    } else if (random_below(state, 4) == 0) {
        frame.flags |= WIRE_REMOTE;
    }
    for (unsigned i = 0; i < frame.length && !(frame.flags & WIRE_REMOTE); i++)
        frame.data[i] = (uint8_t)random_below(state, 256);
    return frame;
}

/* What is behind the data, or asked for, does not count. */
static inline bool random_frame_is_same(const struct wire_frame *a, const struct wire_frame *b)
{
    return a->id == b->id && a->flags == b->flags && a->length == b->length &&
           (a->flags & WIRE_REMOTE || memcmp(a->data, b->data, a->length) == 0);
}

#endif
