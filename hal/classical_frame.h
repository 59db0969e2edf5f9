/*
 * A classical frame as it travels between processors: as long in every build, whatever the longest
 * frame of a port is.
 */
#ifndef TAKT_HAL_CLASSICAL_FRAME_H
#define TAKT_HAL_CLASSICAL_FRAME_H

#include "hal/can.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

struct classical_frame {
    uint16_t id;
    uint8_t length;
    uint8_t data[CAN_CLASSIC_MAX];
    uint8_t unused;
};

_Static_assert(sizeof(struct classical_frame) == 12, "as on every side");

static inline void classical_frame_set(struct classical_frame *to, const struct can_frame *from)
{
    if (sizeof *from == sizeof *to) {
        memcpy(to, from, sizeof *to); /* of a build that has classical CAN alone, at once */
        return;
    }
    to->id = from->id;
    to->length = from->length;
    memcpy(to->data, from->data, sizeof to->data);
    to->unused = 0;
}

static inline void classical_frame_get(const struct classical_frame *from, struct can_frame *to)
{
    if (sizeof *from == sizeof *to) {
        memcpy(to, from, sizeof *from);
        return;
    }
    to->id = from->id;
    to->length = from->length;
    memcpy(to->data, from->data, sizeof from->data);
}

/* Whoever takes one from a processor that is not trusted asks this first. */
static inline bool classical_frame_is_valid(const struct classical_frame *frame)
{
    return frame->length <= CAN_CLASSIC_MAX && (frame->id & ~(CAN_REMOTE | CAN_ID_MASK)) == 0;
}

#endif
