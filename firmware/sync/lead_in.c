#include "sync/lead_in.h"

#include "base/assert.h"
#include "base/maths.h"

/* Peaks of the first and second derivative of s(u) = 10 u^3 - 15 u^4 + 6 u^5. */
#define PEAK_FIRST  1.875
#define PEAK_SECOND 5.7736

/*
 * Its jerk is that of the middle of each cycle. Over fewer than three of them their sum depends on
 * where they fall, and takes the axes back: by 12 times the way over one cycle.
 */
#define CYCLES_MIN 4.0

/*
 * Velocity follows s(t/T) up to v = pitch speed: T = max(PEAK_FIRST v/A, sqrt(PEAK_SECOND v/J)),
 * way = speed T.
 */
double takt_lead_in_way(double pitch_mm, double speed_rev_s, const struct brake_limits *limits,
                        double cycle_s)
{
    const double v = LEAD_IN_ROOM * pitch_mm * speed_rev_s;
    const double time_s = maths_max(PEAK_FIRST * v / limits->acceleration_mm_s2,
                                    maths_sqrt(PEAK_SECOND * v / limits->jerk_mm_s3));

    TAKT_ASSERT(speed_rev_s > 0.0 && cycle_s > 0.0);
    return LEAD_IN_ROOM * speed_rev_s * maths_max(time_s, CYCLES_MIN * cycle_s);
}

bool takt_lead_in_is_over(const struct lead_in *l, double rev)
{
    return rev >= l->zero_rev + 0.5 * l->way_rev;
}

/* x = pitch way integral of s(u), u = (rev - start)/way; the integral is u^4 (5/2 - 3 u + u^2). */
struct lead_in_place takt_lead_in_at(const struct lead_in *l, double rev)
{
    const double u = (rev - l->zero_rev) / l->way_rev + 0.5;

    TAKT_ASSERT(l->way_rev > 0.0);
    if (u <= 0.0) {
        return (struct lead_in_place){0};
    }
    if (u >= 1.0) {
        return (struct lead_in_place){.x = l->pitch_mm * (rev - l->zero_rev), .first = l->pitch_mm};
    }
    const double v = 1.0 - u;

    return (struct lead_in_place){
        .x = l->pitch_mm * l->way_rev * u * u * u * u * (2.5 + u * (u - 3.0)),
        .first = l->pitch_mm * u * u * u * (10.0 + u * (6.0 * u - 15.0)),
        .second = l->pitch_mm / l->way_rev * 30.0 * u * u * v * v,
        .third = l->pitch_mm / (l->way_rev * l->way_rev) * 60.0 * u * v * (1.0 - 2.0 * u),
    };
}
