/*
 * Inside the window: public only so that the caller can own the memory. Read window.h instead.
 */
#ifndef TAKT_PLAN_WINDOW_STATE_H
#define TAKT_PLAN_WINDOW_STATE_H

#include "plan/block.h"
#include "plan/limits.h"

#include <stdbool.h>
#include <stdint.h>

#define WINDOW_BLOCKS_MAX 256

/* Waits without a cycle in a row. With the short blocks after them (8 a cycle) they are fewer than MOTION_QUEUE_MAX. */
#define WINDOW_INSTANT_MAX 4

struct window {
    struct plan_limits limits;
    uint32_t capacity;
    uint32_t first; /* ring of blocks: index of the oldest */
    uint32_t count;
    uint32_t motions; /* motions pushed so far: the number of the newest */
    bool finished;
    struct curve newest;   /* curve of the newest block, valid while that block waits in the ring */
    bool newest_is_motion; /* and is a motion that the next one may join */
    struct point end;      /* where everything pushed ends */
    struct point taken;    /* where everything taken ends */
    double feed_mm_s;      /* at the end of everything taken */
    double phase_s;        /* from that end to the next control cycle, 0 <= phase <= cycle */
    uint32_t instant;      /* waits without a cycle taken in a row */
    struct block block[WINDOW_BLOCKS_MAX];
};

#endif
