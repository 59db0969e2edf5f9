/*
 * Frames of one cycle between the bus, which must not be slowed down, and the bus log, whose time
 * is not the run's.
 */
#ifndef TAKT_HOST_FRAME_BUFFER_H
#define TAKT_HOST_FRAME_BUFFER_H

#include "bus/bus.h"
#include "bus/candump.h"

#include <stdint.h>

/*
 * More than the buses can carry in the longest cycle: 10 ms at 1 Mbit/s are 212 frames without
 * data.
 */
#define FRAME_BUFFER_MAX (256 * CAN_BUSES_MAX)

struct frame_seen {
    struct can_frame frame;
    uint8_t bus;
    uint64_t time_ns;
};

struct frame_buffer {
    unsigned count;
    struct candump *log; /* the caller's */
    struct frame_buffer_tap {
        struct frame_buffer *buffer;
        uint8_t bus;
    } tap[CAN_BUSES_MAX];
    struct frame_seen seen[FRAME_BUFFER_MAX];
};

/* From now on every frame of these buses is kept until the next frame_buffer_write. */
void frame_buffer_attach(struct frame_buffer *buffer, struct bus bus[], unsigned count,
                         struct candump *log);
/* Hands what was kept to the log, in the order of time. */
void frame_buffer_write(struct frame_buffer *buffer);

#endif
