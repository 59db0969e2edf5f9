#include "accuracy/cycle_frequency.h"

#include "base/assert.h"
#include "base/maths.h"

#include <stddef.h>

/* Limits meet where their feeds differ by no more than rounding. */
#define MEETING_RATIO 1e-9

/* H = F / f   (2) */
double takt_cycle_step_mm(double feed_mm_s, double frequency_hz)
{
    TAKT_ASSERT(frequency_hz > 0.0);
    return feed_mm_s / frequency_hz;
}

/* (H/2)^2 / (R + sqrt(R^2 - (H/2)^2)): equation (1) without its cancellation */
double takt_cycle_chord_error_mm(double radius_mm, double step_mm)
{
    const double half = 0.5 * step_mm;

    TAKT_ASSERT(radius_mm >= 0.0 && step_mm >= 0.0);
    if (half >= radius_mm) {
        return radius_mm;
    }
    return half * half / (radius_mm + maths_sqrt((radius_mm - half) * (radius_mm + half)));
}

/* Half the chord whose error is the tolerance, R > d / 2: sqrt(2 R d - d^2) */
static double half_chord_mm(double radius_mm, double tolerance_mm)
{
    TAKT_ASSERT(tolerance_mm >= 0.0 && 2.0 * radius_mm >= tolerance_mm);
    return maths_sqrt(tolerance_mm * (2.0 * radius_mm - tolerance_mm));
}

/*
 * f = F / (2 sqrt(2 R d - d^2))   (3). For R <= d no chord of at most half a turn is farther off
 * than d.
 */
double takt_cycle_frequency_hz(double radius_mm, double feed_mm_s, double tolerance_mm)
{
    if (radius_mm <= tolerance_mm) {
        return 0.0;
    }
    return 0.5 * feed_mm_s / half_chord_mm(radius_mm, tolerance_mm);
}

/* F = 2 f sqrt(2 R d - d^2)   (3) */
double takt_cycle_feed_chord_mm_s(double radius_mm, double frequency_hz, double tolerance_mm)
{
    if (radius_mm <= tolerance_mm) {
        return MATHS_INFINITY;
    }
    return 2.0 * frequency_hz * half_chord_mm(radius_mm, tolerance_mm);
}

/* F = sqrt(R a)   (6) */
double takt_cycle_feed_acceleration_mm_s(double radius_mm, double acceleration_mm_s2)
{
    TAKT_ASSERT(radius_mm >= 0.0 && acceleration_mm_s2 >= 0.0);
    return maths_sqrt(radius_mm * acceleration_mm_s2);
}

/* F = cbrt(J R^2)   (8): jerk of constant feed on a circle */
double takt_cycle_feed_jerk_mm_s(double radius_mm, double jerk_mm_s3)
{
    TAKT_ASSERT(radius_mm >= 0.0 && jerk_mm_s3 >= 0.0);
    return jerk_mm_s3 == MATHS_INFINITY ? MATHS_INFINITY
                                        : takt_maths_cbrt(jerk_mm_s3 * radius_mm * radius_mm);
}

double takt_cycle_feed_allowed_mm_s(const struct cycle_limits *limits, double radius_mm,
                                    unsigned *governing)
{
    const double a = takt_cycle_feed_acceleration_mm_s(radius_mm, limits->acceleration_mm_s2);
    const double j = takt_cycle_feed_jerk_mm_s(radius_mm, limits->jerk_mm_s3);
    const double feed = maths_min(limits->feed_mm_s, maths_min(a, j));
    const double near = feed * (1.0 + MEETING_RATIO);

    if (governing != NULL) {
        *governing = (limits->feed_mm_s <= near ? CYCLE_LIMIT_FEED : 0U) |
                     (a <= near ? CYCLE_LIMIT_ACCELERATION : 0U) |
                     (j <= near ? CYCLE_LIMIT_JERK : 0U);
    }
    return feed;
}

/* Takes a radius into account; radii at or below the tolerance and infinite ones need nothing. */
static void consider(const struct cycle_limits *limits, double tolerance_mm, double radius_mm,
                     struct cycle_need *need)
{
    unsigned governing;

    if (!(radius_mm >= tolerance_mm) || !maths_is_finite(radius_mm)) {
        return;
    }
    const double feed = takt_cycle_feed_allowed_mm_s(limits, radius_mm, &governing);
    const double frequency = 0.5 * feed / half_chord_mm(radius_mm, tolerance_mm);

    if (frequency > need->frequency_hz) {
        *need = (struct cycle_need){frequency, radius_mm, feed, governing};
    }
}

/*
 * f(R) is F(R) / (2 sqrt(2 R d - d^2)) with F(R) the lowest of three curves. By its derivative it
 * falls all along the feed and the acceleration branch; on the jerk branch, F ~ R^(2/3), it falls
 * until R = 2 d and rises from there. So its highest value is at the lower end, R = d, or where two
 * branches meet: at
 *     jerk and acceleration  R = a^3 / J^2
 *     jerk and feed          R = sqrt(F^3 / J)
 *     acceleration and feed  R = F^2 / a
 * Below R = d the formula has a pole at d / 2 that means nothing.
 */
void takt_cycle_frequency_find(const struct cycle_limits *limits, double tolerance_mm,
                               struct cycle_need *need)
{
    const double f = limits->feed_mm_s;
    const double a = limits->acceleration_mm_s2;
    const double j = limits->jerk_mm_s3;

    *need = (struct cycle_need){.radius_mm = tolerance_mm};
    consider(limits, tolerance_mm, tolerance_mm, need);
    consider(limits, tolerance_mm, a * a * a / (j * j), need);
    consider(limits, tolerance_mm, maths_sqrt(f * f * f / j), need);
    consider(limits, tolerance_mm, f * f / a, need);
}
