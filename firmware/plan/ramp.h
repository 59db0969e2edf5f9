/*
 * Jerk-limited feed ramps: from one feed to another with zero acceleration at both ends, in the least time that
 * acceleration a and jerk j allow. Source: seed 003 section 1; the closed forms are derived in ramp.c.
 *
 * Feeds mm/s (>= 0), lengths mm, a mm/s2 and j mm/s3 (> 0) along the path.
 */
#ifndef TAKT_PLAN_RAMP_H
#define TAKT_PLAN_RAMP_H

#include "plan/profile.h"

struct ramp_limits {
    double a_mm_s2;
    double j_mm_s3;
};

/* Time of a change of feed by delta_mm_s >= 0. */
double ramp_duration(double delta_mm_s, const struct ramp_limits *limits);

/* Path length of the ramp between two feeds; the order does not matter. */
double ramp_length(double from_mm_s, double to_mm_s, const struct ramp_limits *limits);

/* The highest feed that a ramp from (or down to) low_mm_s connects within length_mm. */
double ramp_reach(double low_mm_s, double length_mm, const struct ramp_limits *limits);

/*
 * Appends the pieces of the ramp from one feed to another to p, which ends at s_mm. Returns s at the end of the ramp.
 * Equal feeds append nothing.
 */
double ramp_append(struct profile *p, double s_mm, double from_mm_s, double to_mm_s,
                   const struct ramp_limits *limits);

#endif
