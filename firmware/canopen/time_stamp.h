/*
 * TIME: the time of day, as one node tells it to all others (CiA 301, 7.2.6).
 */
#ifndef TAKT_CANOPEN_TIME_STAMP_H
#define TAKT_CANOPEN_TIME_STAMP_H

#include "hal/can.h"

#include <stdbool.h>
#include <stdint.h>

#define TIME_COB_ID       0x100
#define TIME_FRAME_LENGTH 6

#define TIME_MS_PER_DAY 86400000u

struct time_stamp {
    uint32_t ms;   /* since midnight */
    uint16_t days; /* since 1 January 1984 */
};

void takt_time_stamp_write(struct can_frame *frame, const struct time_stamp *time);
/* False: it is not of that length, or no time of a day. The identifier is the caller's business. */
bool takt_time_stamp_read(const struct can_frame *frame, struct time_stamp *time);

/* The time by_ms later. */
struct time_stamp takt_time_stamp_add(struct time_stamp time, uint64_t by_ms);

#endif
