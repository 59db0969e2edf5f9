/*
 * What the axes allow of a change of the rate of a hold (hold.c): on a part of the way, and where
 * it is.
 */
#ifndef TAKT_MOTION_HOLD_AXES_H
#define TAKT_MOTION_HOLD_AXES_H

#include "motion/hold.h"

#include <stdbool.h>

struct range {
    float low;
    float high;
};

/*
 * A state that is tried, in single precision: what rounding does to it is less than the bounds
 * leave. What is gone along is in double precision.
 */
struct hold_trial {
    float at;
    float rate;
    float change;
};

/* Fills in what is stored of a piece behind its highest rate. */
void takt_hold_bound(const struct hold *h, float *piece);

/*
 * Can it go from one state to another by w, on pieces that are known, and not back? In one
 * direction of the change.
 */
bool takt_hold_can_go(struct hold *h, const struct hold_trial *a, const struct hold_trial *b,
                      float w);

/* Where it gets by w in this time, cycles. */
void takt_hold_try(struct hold_trial *s, float w, float time);

/*
 * It goes on by w, for this time or until the change is another one: can it within all limits? The
 * change does not come to the other side of 0.
 */
bool takt_hold_can_pass(struct hold *h, struct hold_trial *s, float w, float time);
bool takt_hold_can_change(struct hold *h, struct hold_trial *s, float to, float w);

/* w between which every axis keeps A and J where it is; limited where none moves. */
struct range takt_hold_steps(const struct hold *h);

/*
 * How hard w, and how great a change that brakes, each of the pieces that are known allows by
 * itself; limited likewise.
 */
struct hold_ending takt_hold_hardest(const struct hold *h);

#endif
