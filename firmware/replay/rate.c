#include "replay/rate.h"

#include "base/assert.h"
#include "base/maths.h"

/* What an evaluation once a cycle may be off the formulas of a rate that changes all the time. */
#define RATE_MARGIN 0.97

/* Parts of the jerk that is left: for the change of the rate's change. */
#define ROOM_PART 0.4

/* Cycles that coming to rest takes beyond the way along its limit: to begin it and to end it. */
#define BRAKE_MORE_CYCLES 400.0

/* Steps of the search for the rate from which braking is possible. */
#define HIGHEST_HALVINGS 20

void takt_rate_init(struct rate *r, const struct plan_limits *limits, double kept)
{
    struct rate_limits *l = &r->limits;

    TAKT_ASSERT(kept > 0.0 && kept < 1.0 && limits->cycle_s > 0.0);
    *r = (struct rate){.limits = {kept, 1.0, 1.0}, .now = 1.0};
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        const double v = limits->velocity_mm_s[i] * limits->cycle_s;
        const double a = limits->acceleration_mm_s2[i] * limits->cycle_s * limits->cycle_s;
        const double j =
            limits->jerk_mm_s3[i] * limits->cycle_s * limits->cycle_s * limits->cycle_s;

        if ((limits->axes & (1U << i)) == 0) {
            continue;
        }
        l->change = maths_min(l->change, RATE_MARGIN * a / v);
        l->change = maths_min(l->change, RATE_MARGIN * j / (5.0 * a));
        l->change = maths_min(l->change, RATE_MARGIN * maths_sqrt(j / (5.0 * v)));
        l->room = maths_min(l->room, RATE_MARGIN * ROOM_PART * j / v);
        TAKT_ASSERT(l->change > 0.0 && l->room > 0.0);
    }
}

void takt_rate_set(struct rate *r, double to)
{
    TAKT_ASSERT(to >= 0.0 && to <= 1.0);
    r->now = to;
    r->change = 0.0;
}

/* How much the change may change in a cycle, at a rate. */
static double room_at(const struct rate_limits *l, double rate)
{
    return l->room * (1.0 - l->kept * rate * rate * rate);
}

/*
 * The change of the next cycle from which the way is still enough to come to rest, by room every
 * cycle: with s = n room the cycles to come lead (this one's mean) + s^2 / (2 room).
 */
static double landing_change(double way, double change, double room)
{
    const double left = way - 0.5 * change;

    TAKT_ASSERT(room > 0.0);
    return left > 0.0 ? room * (maths_sqrt(0.25 + 2.0 * left / room) - 0.5) : 0.0;
}

/* The cycle that changes the rate towards to, by at most room and to a change of at most most. */
static double second_towards(const struct rate *r, double to, double room, double landing,
                             double most)
{
    const double sign = to > r->now ? 1.0 : -1.0;
    const double way = maths_abs(to - r->now);
    const double wanted = maths_min(landing_change(way, sign * r->change, landing), most);

    return maths_clamp(sign * wanted - r->change, -room, room);
}

double takt_rate_second(const struct rate *r, double to, double room, double most)
{
    return second_towards(r, to, room, room, most);
}

double takt_rate_step(struct rate *r, double to)
{
    const struct rate_limits *l = &r->limits;
    const double high =
        maths_clamp(r->now + r->change + room_at(l, r->now), r->now, 1.0); /* within this cycle */
    const double room = room_at(l, high);
    const double landing = room_at(l, maths_max(high, to));
    const double before = r->now;

    TAKT_ASSERT(to >= 0.0 && to <= 1.0 && r->now >= 0.0 && r->now <= 1.0);
    if (maths_abs(to - r->now) <= 0.5 * landing && maths_abs(r->change) <= landing) {
        r->now = to;
        r->change = 0.0;
        return 0.5 * (before + to);
    }
    const double second =
        second_towards(r, to, room, landing, l->change * (1.0 - l->kept * high * high));

    r->now = maths_clamp(r->now + r->change + 0.5 * second, 0.0, 1.0);
    r->change += second;
    return before + 0.5 * (r->now - before) - second / 12.0;
}

/* Along |r'| = L (1 - k r^2): the integral of r dr / (L (1 - k r^2)) is -ln(1 - k) / (2 L k). */
static double brake_cycles_from(const struct rate *r, double rate)
{
    const double k = r->limits.kept;

    return -takt_maths_ln(1.0 - k * rate * rate) / (2.0 * r->limits.change * k) + BRAKE_MORE_CYCLES;
}

double takt_rate_brake_cycles(const struct rate *r)
{
    return brake_cycles_from(r, 1.0);
}

double takt_rate_highest(const struct rate *r, double cycles)
{
    double low = 0.0;
    double high = 1.0;

    if (takt_rate_brake_cycles(r) <= cycles) {
        return 1.0;
    }
    for (int i = 0; i < HIGHEST_HALVINGS; i++) {
        const double middle = 0.5 * (low + high);

        if (brake_cycles_from(r, middle) <= cycles) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}
