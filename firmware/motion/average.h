/*
 * The moving average that makes the setpoint's path position out of the trapezoidal reference's:
 * one to three boxes, one after the other (plan/profile.h). Exact: sums of whole path units, modulo
 * 2^64, of which only differences are used.
 */
#ifndef TAKT_MOTION_AVERAGE_H
#define TAKT_MOTION_AVERAGE_H

#include "plan/ramp_profile.h"

#include <stdint.h>

/*
 * Two boxes of RAMP_PROFILE_SMOOTH need most: the second is half as long. Those of
 * RAMP_PROFILE_GENTLE are much shorter (takt_ramp_profile_cycles_max).
 */
#define AVERAGE_INPUTS_MAX (RAMP_PROFILE_CYCLES_MAX + RAMP_PROFILE_CYCLES_MAX / 2)

struct average_box {
    uint64_t sum;        /* of the inputs that the box reaches over */
    uint32_t first, end; /* their places */
    uint32_t next;       /* of these places: the oldest input, that of the next one */
    uint32_t old;        /* how many of them are older than the start: not in their places */
    uint64_t oldest;     /* of those, the oldest, and from each to the next */
    uint64_t step;
};

struct average {
    unsigned boxes;
    uint64_t at;    /* newest input */
    uint64_t scale; /* product of the boxes' cycles */
    double product; /* likewise */
    struct average_box box[RAMP_PROFILE_BOXES_MAX];
    uint64_t input[AVERAGE_INPUTS_MAX]; /* of all boxes, one after the other */
};

/*
 * The trapezoidal reference is at this position and has always moved by step, path units a cycle.
 * cycles: of the first box, 1 ... takt_ramp_profile_cycles_max.
 */
void takt_average_start(struct average *a, enum ramp_profile profile, uint32_t cycles, uint64_t at,
                        uint64_t step);

/* The next position of the trapezoidal reference, path units. */
void takt_average_push(struct average *a, uint64_t at);

/* How far the average follows behind the newest input: path units, >= 0. 0 at rest. */
static inline double average_lag(const struct average *a)
{
    /*
     * the last sum is product times the average, modulo 2^64; product times the newest input minus
     * it is small
     */
    return (double)(int64_t)(a->at * a->scale - a->box[a->boxes - 1].sum) / a->product;
}

#endif
