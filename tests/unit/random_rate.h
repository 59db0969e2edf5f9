/*
 * Random machines for the rate of compiled programs, and what a change of the rate needs of their
 * axes.
 */
#ifndef TAKT_TESTS_RANDOM_RATE_H
#define TAKT_TESTS_RANDOM_RATE_H

#include "base/maths.h"
#include "replay/rate.h"

#include <stdint.h>
#include <string.h>

#define RANDOM_RATE_KEPT    0.996
#define RANDOM_RATE_CYCLE_S 1e-3

static uint64_t random_rate_seed;

static inline double random_rate_between(double low, double high)
{
    random_rate_seed =
        random_rate_seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(random_rate_seed >> 11) / 9007199254740992.0;
}

/* Jerk reaches the acceleration in 5 cycles or more. */
static inline struct plan_limits random_rate_machine(void)
{
    struct plan_limits l;

    memset(&l, 0, sizeof(l));
    l.axes = 7;
    l.cycle_s = RANDOM_RATE_CYCLE_S;
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        l.velocity_mm_s[i] = takt_maths_power(10.0, random_rate_between(1.3, 2.7));
        l.acceleration_mm_s2[i] = takt_maths_power(10.0, random_rate_between(2.3, 4.0));
        l.jerk_mm_s3[i] =
            l.acceleration_mm_s2[i] / (RANDOM_RATE_CYCLE_S * random_rate_between(5.0, 100.0));
    }
    return l;
}

/*
 * Need of one axis, at a place of the curve that needs all it may, in a cycle between two states of
 * the rate: acceleration and jerk over the limits (rate.h), with the larger of what the rate was
 * and is.
 */
static inline double random_rate_need(const struct plan_limits *l, int axis,
                                      const struct rate *before, const struct rate *now)
{
    const double v = l->velocity_mm_s[axis] * l->cycle_s;
    const double a = l->acceleration_mm_s2[axis] * l->cycle_s * l->cycle_s;
    const double j = l->jerk_mm_s3[axis] * l->cycle_s * l->cycle_s * l->cycle_s;
    const double r = maths_max(before->now, now->now);
    const double change = maths_max(maths_abs(before->change), maths_abs(now->change));
    const double bend = maths_abs(now->change - before->change);
    const double by_acceleration = RANDOM_RATE_KEPT * r * r + v / a * change;
    const double by_jerk = RANDOM_RATE_KEPT * r * r * r + 3.0 * a / j * r * change + v / j * bend;

    return maths_max(by_acceleration, by_jerk);
}

#endif
