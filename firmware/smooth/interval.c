#include "smooth/interval.h"

#include "base/assert.h"
#include "base/maths.h"
#include "smooth/window.h"

/*
 * Nominal time between samples, as a part of the time that a way of the tolerance takes: cbrt(P/J) where jerk binds,
 * sqrt(P/A) where acceleration does, whichever is longer. Found on machines of P J^2/A^3 = 4e-4 ... 640: README.md.
 */
#define INTERVAL_OF_JERK         0.7
#define INTERVAL_OF_ACCELERATION 0.9

/* A window is at least this part of the time in which the slowest axis reaches its velocity: README.md. */
#define WINDOW_OF_RAMP 0.5

/* Time in which the slowest axis reaches its velocity: V/A + A/J, or 2 sqrt(V/J) where A is not reached. */
static double longest_ramp(const struct smooth_limits *limits, unsigned axes)
{
    double longest = 0.0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        const double v = limits->velocity_mm_s[i];
        const double j = limits->jerk_mm_s3[i];
        const double a = maths_min(limits->acceleration_mm_s2[i], maths_sqrt(v * j));

        if ((axes >> i & 1U) != 0) {
            longest = maths_max(longest, v / a + a / j);
        }
    }
    return longest;
}

/* Interval by the axis that crosses the tolerance soonest. */
static double soonest_interval(const struct smooth_limits *curve, unsigned axes,
                               double tolerance_mm)
{
    double soonest = MATHS_INFINITY;

    for (int i = 0; i < AXIS_COUNT; i++) {
        if ((axes >> i & 1U) != 0) {
            const double p = tolerance_mm / smooth_weight(i);
            const double jerk = INTERVAL_OF_JERK * takt_maths_cbrt(p / curve->jerk_mm_s3[i]);
            const double acceleration =
                INTERVAL_OF_ACCELERATION * maths_sqrt(p / curve->acceleration_mm_s2[i]);

            soonest = maths_min(soonest, maths_max(jerk, acceleration));
        }
    }
    return maths_max(curve->cycle_s, soonest);
}

double takt_interval_of(const struct smooth_limits *machine, const struct route *r, unsigned axes,
                        double tolerance_mm)
{
    struct smooth_limits curve = *machine;

    TAKT_ASSERT(axes != 0 && tolerance_mm > 0.0);
    takt_smooth_limit(&curve, r->tolerance_mm);
    return maths_max(soonest_interval(&curve, axes, tolerance_mm),
                     longest_ramp(machine, axes) * WINDOW_OF_RAMP / window_capacity(r));
}
