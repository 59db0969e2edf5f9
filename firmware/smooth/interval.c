#include "smooth/interval.h"

#include "base/assert.h"
#include "base/maths.h"
#include "smooth/window.h"

/*
 * Nominal time between samples, as a part of the time that a way of the tolerance takes: cbrt(P/J)
 * where jerk binds, sqrt(P/A) where acceleration does, whichever is longer. Found on machines of P
 * J^2/A^3 = 4e-4 ... 640: README.md.
 */
#define INTERVAL_OF_JERK         0.7
#define INTERVAL_OF_ACCELERATION 0.9

/* It is at least this part of a cycle, for which two pieces are planned at most. */
#define INTERVAL_LEAST_CYCLES 0.5

/*
 * A window is at least this part of the time in which the slowest axis reaches its velocity:
 * README.md.
 */
#define WINDOW_OF_RAMP 0.5

/* Of a chain's reach at most this part is cut at a corner: of more tolerance it has no use. */
#define CUT_OF_REACH 0.5

/* A chain has so many intervals at least at its nominal feed before it needs shorter ones. */
#define INTERVALS_LEAST 16.0

double takt_interval_reach(const struct route *r)
{
    double start[AXIS_COUNT];
    double p[AXIS_COUNT];
    double most = 0.0;

    TAKT_ASSERT(r->count > r->first);
    takt_route_place(r, r->first, route_element(r, r->first)->start_mm, start);
    for (uint32_t i = r->first; i < r->count; i++) {
        const struct route_element *e = route_element(r, i);
        const double beside = e->curved ? 0.5 * (route_end_of(r, i) - e->start_mm) : 0.0;

        takt_route_place(r, i, route_end_of(r, i), p);
        for (unsigned k = 0; k < r->slots.count; k++) {
            most = maths_max(most, maths_abs(p[k] - start[k]) + beside);
        }
    }
    return most;
}

/*
 * The velocity that an axis reaches at most on a way of twice the reach: sqrt(2 L A), cbrt(L^2 J).
 */
static double velocity_within(const struct smooth_limits *limits, int axis, double reach_mm)
{
    const double way = reach_mm / smooth_weight(axis);

    return maths_min(limits->velocity_mm_s[axis],
                     maths_min(maths_sqrt(2.0 * way * limits->acceleration_mm_s2[axis]),
                               takt_maths_cbrt(way * way * limits->jerk_mm_s3[axis])));
}

/*
 * Time in which the slowest axis reaches its velocity: V/A + A/J, or 2 sqrt(V/J) where A is not
 * reached.
 */
static double longest_ramp(const struct smooth_limits *limits, unsigned axes, double reach_mm)
{
    double longest = 0.0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        const double v = velocity_within(limits, i, reach_mm);
        const double j = limits->jerk_mm_s3[i];
        const double a = maths_min(limits->acceleration_mm_s2[i], maths_sqrt(v * j));

        if ((axes >> i & 1U) != 0 && v > 0.0) {
            longest = maths_max(longest, v / a + a / j);
        }
    }
    return longest;
}

double takt_interval_least(const struct smooth_limits *machine)
{
    return INTERVAL_LEAST_CYCLES * machine->cycle_s;
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
    return maths_max(takt_interval_least(curve), soonest);
}

static double interval_within(const struct smooth_limits *machine, const struct route *r,
                              unsigned axes, double tolerance_mm, double reach_mm)
{
    struct smooth_limits curve = *machine;

    takt_smooth_limit(&curve);
    return maths_max(
        soonest_interval(&curve, axes, maths_min(tolerance_mm, CUT_OF_REACH * reach_mm)),
        longest_ramp(machine, axes, reach_mm) * WINDOW_OF_RAMP / window_capacity(r));
}

/*
 * Where all of a chain is known it may be so short that it has no use for all of the tolerance, nor
 * its axes for their velocity. Its intervals are the shorter then, but no more than it takes to
 * have a few at the nominal feed: a slow one gains nothing by more.
 */
double takt_interval_of(const struct smooth_limits *machine, const struct route *r, unsigned axes,
                        double tolerance_mm, bool whole)
{
    const double any = interval_within(machine, r, axes, tolerance_mm, MATHS_INFINITY);

    TAKT_ASSERT(axes != 0 && tolerance_mm > 0.0);
    if (!whole) {
        return any;
    }
    const double start_mm = route_element(r, r->first)->start_mm;
    const double time = (double)takt_route_time(r, r->first, start_mm, takt_route_end(r));
    const double least = interval_within(machine, r, axes, tolerance_mm, takt_interval_reach(r));

    return maths_min(any, maths_max(least, time / INTERVALS_LEAST));
}
