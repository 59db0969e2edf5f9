#include "smooth/limits.h"

#include "base/assert.h"
#include "base/maths.h"

/* Part of the tolerance that the chords between setpoints may take, for each axis. */
#define CHORD_PART 0.25

/*
 * Acceleration at a corner within the tolerance, in parts of what jerk alone comes to, cbrt(P J^2).
 */
#define CORNER_PART 1.5

/*
 * Between -V and V an axis comes to sqrt(2 V J) at most, rising and falling by J: what it could do
 * beyond that is of no use, and nothing is to depend on it.
 */
static void limit_reached(struct smooth_limits *limits)
{
    for (int i = 0; i < AXIS_COUNT; i++) {
        limits->acceleration_mm_s2[i] =
            maths_min(limits->acceleration_mm_s2[i],
                      maths_sqrt(2.0 * limits->velocity_mm_s[i] * limits->jerk_mm_s3[i]));
    }
}

/*
 * A chord of one cycle leaves the curve by A cycle^2/8 at most: where that is much of the
 * tolerance, less acceleration is used. At a corner there is no more than jerk leaves time for.
 */
static void limit_chord(struct smooth_limits *limits, double tolerance_mm)
{
    const double t = limits->cycle_s * limits->cycle_s / 8.0;
    double square = 0.0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        const double weight = smooth_weight(i);

        limits->acceleration_mm_s2[i] =
            maths_min(limits->acceleration_mm_s2[i], CHORD_PART * tolerance_mm / (weight * t));
        if ((limits->axes >> i & 1U) != 0) {
            const double j = limits->jerk_mm_s3[i] * weight;
            const double a = maths_min(limits->acceleration_mm_s2[i] * weight,
                                       CORNER_PART * takt_maths_cbrt(tolerance_mm * j * j));

            square += a * a;
        }
    }
    limits->chord_mm = maths_sqrt(square) * t;
}

void takt_smooth_limit(struct smooth_limits *limits, double tolerance_mm)
{
    TAKT_ASSERT(limits->cycle_s > 0.0 && tolerance_mm > 0.0);
    limit_reached(limits);
    limit_chord(limits, tolerance_mm);
}
