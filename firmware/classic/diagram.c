#include "classic/diagram.h"

#include "base/assert.h"
#include "base/maths.h"
#include "classic/s_curve.h"

/* Halvings of an interval of feeds: until a part of 1e-12 of it is left. */
#define HALVINGS 40

/* A time that is longer than whole cycles by less than this part of one is rounding. */
#define CYCLE_SLACK 1e-9

double takt_diagram_ramp_s(const struct diagram_limits *limits, double change_mm_s)
{
    double round;

    TAKT_ASSERT(limits->a_mm_s2 > 0.0 && limits->j_mm_s3 > 0.0);
    return takt_s_curve_time(change_mm_s, limits->a_mm_s2, limits->j_mm_s3, &round);
}

/* A symmetric ramp covers its mean feed times its time. */
static double ramp_way(const struct diagram_limits *limits, double from_mm_s, double to_mm_s)
{
    TAKT_ASSERT(from_mm_s >= 0.0 && to_mm_s >= 0.0);
    return 0.5 * (from_mm_s + to_mm_s) *
           takt_diagram_ramp_s(limits, maths_abs(to_mm_s - from_mm_s));
}

double takt_diagram_reach(const struct diagram_limits *limits, double feed_mm_s)
{
    double low = feed_mm_s;
    double high = limits->feed_mm_s;

    if (high <= low || ramp_way(limits, low, high) <= limits->length_mm) {
        return high;
    }
    for (int i = 0; i < HALVINGS; i++) {
        const double middle = 0.5 * (low + high);

        if (ramp_way(limits, feed_mm_s, middle) <= limits->length_mm) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

/* The highest feed that both ramps leave room for. */
static double find_cruise(const struct diagram_limits *limits, double start, double end)
{
    double low = maths_max(start, end);
    double high = maths_max(low, limits->feed_mm_s);

    for (int i = 0; i < HALVINGS; i++) {
        const double feed = i == 0 ? high : 0.5 * (low + high);

        if (ramp_way(limits, start, feed) + ramp_way(limits, feed, end) <= limits->length_mm) {
            low = feed;
        } else {
            high = feed;
        }
    }
    return low;
}

static double whole_cycles(double time_s, double cycle_s)
{
    TAKT_ASSERT(cycle_s > 0.0);
    return cycle_s * takt_maths_ceil(time_s / cycle_s - CYCLE_SLACK);
}

static double set_ramp(const struct diagram_limits *limits, double change, double cycle_s,
                       double *round)
{
    return whole_cycles(takt_s_curve_time(change, limits->a_mm_s2, limits->j_mm_s3, round),
                        cycle_s);
}

void takt_diagram_set(struct diagram *d, const struct diagram_limits *limits, double start_mm_s,
                      double end_mm_s, double cycle_s)
{
    TAKT_ASSERT(cycle_s > 0.0 && start_mm_s >= 0.0 && end_mm_s >= 0.0);
    d->start_mm_s = start_mm_s;
    d->end_mm_s = end_mm_s;
    d->cruise_mm_s = find_cruise(limits, start_mm_s, end_mm_s);
    d->up_s = set_ramp(limits, d->cruise_mm_s - start_mm_s, cycle_s, &d->up_round);
    d->down_s = set_ramp(limits, d->cruise_mm_s - end_mm_s, cycle_s, &d->down_round);
    const double ramps_mm = 0.5 * (start_mm_s + d->cruise_mm_s) * d->up_s +
                            0.5 * (d->cruise_mm_s + end_mm_s) * d->down_s;
    const double even_s = (limits->length_mm - ramps_mm) / d->cruise_mm_s;

    d->even_s = whole_cycles(maths_max(0.0, even_s), cycle_s);
    d->kl = limits->length_mm / (ramps_mm + d->cruise_mm_s * d->even_s);
}

double takt_diagram_time(const struct diagram *d)
{
    return d->up_s + d->even_s + d->down_s;
}

bool takt_diagram_brakes(const struct diagram *d, double time_s)
{
    return time_s > d->up_s + d->even_s;
}

/* Way of a part of a ramp: F0 t + (F1 - F0) T integral(t/T). */
static double way_of_ramp(double from, double to, double total_s, double round, double time_s)
{
    return from * time_s + (to - from) * total_s * takt_s_curve_integral(time_s / total_s, round);
}

double takt_diagram_way(const struct diagram *d, double time_s)
{
    const double up_mm = 0.5 * (d->start_mm_s + d->cruise_mm_s) * d->up_s;
    const double down_s = time_s - d->up_s - d->even_s;

    if (time_s < d->up_s) {
        return d->kl * way_of_ramp(d->start_mm_s, d->cruise_mm_s, d->up_s, d->up_round, time_s);
    }
    if (down_s <= 0.0) {
        return d->kl * (up_mm + d->cruise_mm_s * (time_s - d->up_s));
    }
    return d->kl * (up_mm + d->cruise_mm_s * d->even_s +
                    way_of_ramp(d->cruise_mm_s, d->end_mm_s, d->down_s, d->down_round,
                                maths_min(down_s, d->down_s)));
}

double takt_diagram_feed(const struct diagram *d, double time_s)
{
    const double down_s = time_s - d->up_s - d->even_s;

    if (time_s < d->up_s) {
        return d->kl * (d->start_mm_s + (d->cruise_mm_s - d->start_mm_s) *
                                            takt_s_curve(time_s / d->up_s, d->up_round));
    }
    if (down_s <= 0.0) {
        return d->kl * d->cruise_mm_s;
    }
    return d->kl *
           (d->cruise_mm_s - (d->cruise_mm_s - d->end_mm_s) *
                                 takt_s_curve(maths_min(1.0, down_s / d->down_s), d->down_round));
}
