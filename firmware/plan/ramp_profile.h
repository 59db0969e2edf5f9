/*
 * The ramp profile: by which curve the feed goes from one value to another. See profiles.md.
 *
 * The trapezoidal reference (firmware/motion) moves with constant acceleration; the setpoint's path
 * position is its average over a window of cycles. One box average makes the seven-segment profile
 * of limited jerk; a second and a third, half as long, make jerk and its derivative continuous.
 */
#ifndef TAKT_PLAN_RAMP_PROFILE_H
#define TAKT_PLAN_RAMP_PROFILE_H

#include <stdint.h>

enum ramp_profile {
    RAMP_PROFILE_JERK,   /* time-optimal for limited acceleration and jerk */
    RAMP_PROFILE_SMOOTH, /* jerk continuous */
    RAMP_PROFILE_GENTLE  /* jerk continuous and its derivative too */
};

#define RAMP_PROFILE_BOXES_MAX 3

/* All boxes together, in parts of the first one. */
double takt_ramp_profile_windows(enum ramp_profile profile);

/* Cycles of a box at most. */
#define RAMP_PROFILE_CYCLES_MAX 256

/* Cycles that the first box of a profile may have: the averages' sums stay within 64 bits. */
uint32_t takt_ramp_profile_cycles_max(enum ramp_profile profile);

/* Boxes of a profile, 1 ... LAW_BOXES_MAX. */
unsigned takt_ramp_profile_boxes(enum ramp_profile profile);

/*
 * Cycles of box i < takt_ramp_profile_boxes when the first one has this many: the others half of
 * it, rounded up.
 */
uint32_t takt_ramp_profile_box_cycles(unsigned i, uint32_t cycles);

/*
 * Cycles that the averages together reach over: a setpoint depends on this many positions of the
 * trapezoidal reference.
 */
uint32_t takt_ramp_profile_window_cycles(enum ramp_profile profile, uint32_t cycles);

#endif
