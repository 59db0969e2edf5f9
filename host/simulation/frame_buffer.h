/*
 * Frames of one cycle between the bus, which must not be slowed down, and the bus log, whose time is not the run's.
 */
#ifndef TAKT_HOST_FRAME_BUFFER_H
#define TAKT_HOST_FRAME_BUFFER_H

#include "bus/bus.h"
#include "bus/candump.h"

#include <stdint.h>

/* More than a bus can carry in the longest cycle: 10 ms at 1 Mbit/s are 212 frames without data. */
#define FRAME_BUFFER_MAX 256

struct frame_buffer {
    unsigned count;
    struct candump *log; /* the caller's */
    struct {
        struct can_frame frame;
        uint64_t time_ns;
    } seen[FRAME_BUFFER_MAX];
};

/* From now on every frame of the bus is kept until the next frame_buffer_write. */
void frame_buffer_attach(struct frame_buffer *buffer, struct bus *bus, struct candump *log);
/* Hands what was kept to the log. */
void frame_buffer_write(struct frame_buffer *buffer);

#endif
