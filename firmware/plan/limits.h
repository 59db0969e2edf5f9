/*
 * What a machine can do, as the planner needs it.
 */
#ifndef TAKT_PLAN_LIMITS_H
#define TAKT_PLAN_LIMITS_H

#include "base/point.h"
#include "plan/ramp_profile.h"

/* Where a control cycle falls on the end of a block exactly. */
enum landing {
    LANDING_SPAN,  /* where spans end: stops, and junctions that need a lower feed */
    LANDING_BLOCK, /* at every block's end, as the source has it */
    /*
     * likewise, by the source's factor kl on the feed: not planned here, but in classic/product.h
     */
    LANDING_SCALE
};

struct plan_limits {
    unsigned axes; /* bit i set: the machine has axis i */
    double velocity_mm_s[AXIS_COUNT];
    double acceleration_mm_s2[AXIS_COUNT];
    double jerk_mm_s3[AXIS_COUNT];
    double cycle_s; /* control cycle */
    double
        chord_error_max_mm; /* largest deviation of the chord between two cycles from the curve */
    enum ramp_profile profile;
    enum landing landing;
};

#endif
