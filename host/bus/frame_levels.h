/*
 * A frame of a port as the levels on the wire, bit by bit, for whoever asks what becomes of a
 * flipped one.
 */
#ifndef TAKT_BUS_FRAME_LEVELS_H
#define TAKT_BUS_FRAME_LEVELS_H

#include "hal/can.h"

#include <stdbool.h>
#include <stdint.h>

/* More than any: 64 bytes of CAN FD with worst-case stuffing are 29 + 678 bits. */
#define FRAME_LEVELS_MAX 720

struct frame_levels {
    unsigned count;   /* as many as frame_bits_count_port says */
    unsigned stuffed; /* how many of them, from the start, obey stuffing */
    unsigned data_begin,
        data_end; /* those from data_begin to before data_end are sent at the data rate */
    uint8_t level[FRAME_LEVELS_MAX]; /* 0 dominant, 1 recessive; stuffed bits included */
};

void frame_levels_set(struct frame_levels *levels, const struct can_frame *frame, bool fd);

#endif
