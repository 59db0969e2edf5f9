/*
 * The control cycle: planned segments in, one setpoint of every axis out, once a cycle.
 *
 * A short queue of segments stands between the planner, which works when there is time, and the cycle, which must not
 * wait. The cycle's cost is bounded: one evaluation of profile and curve, and at most MOTION_QUEUE_MAX segments passed.
 */
#ifndef TAKT_MOTION_MOTION_H
#define TAKT_MOTION_MOTION_H

#include "motion/cycle_record.h"
#include "plan/segment.h"

#include <stdbool.h>
#include <stdint.h>

/*
 * Segments ahead of the cycle: more than one cycle can pass, which is the blocks that begin or end in it (9, by the
 * planner's ceiling for short blocks) and WINDOW_INSTANT_MAX events.
 */
#define MOTION_QUEUE_MAX 16

enum motion_result {
    MOTION_CYCLE,  /* the record holds this cycle */
    MOTION_DONE,   /* the segment that ends the program has been reached: no cycle was made */
    MOTION_STARVED /* the queue is empty before the end: no cycle was made */
};

struct motion {
    double cycle_s;
    uint64_t cycles; /* made so far */
    struct point at; /* last commanded position */
    uint64_t passed; /* cycles made inside the segment being executed */
    uint32_t first;
    uint32_t count;
    struct segment queue[MOTION_QUEUE_MAX];
};

void motion_init(struct motion *m, double cycle_s, const struct point *start);
bool motion_has_room(const struct motion *m);
/* The segment to fill, followed by motion_push. Needs room. */
struct segment *motion_next_slot(struct motion *m);
void motion_push(struct motion *m);

/* One control cycle. Fills cycle, time, block, line, feed, cmd and landed of the record. */
enum motion_result motion_cycle(struct motion *m, struct cycle_record *record);

/* The segment the last cycle executed. Valid until the next cycle. */
const struct segment *motion_segment(const struct motion *m);

#endif
