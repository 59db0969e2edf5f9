#include "replay/rate.h"

#include "base/assert.h"
#include "base/maths.h"

/* What an evaluation once a cycle may be off the formulas of a rate that changes all the time. */
#define RATE_MARGIN 0.97

/* Parts of the jerk that is left: for the change of the rate's change. */
#define ROOM_PART 0.4

/* Cycles that coming to rest takes beyond the way along its limit: to begin it and to end it. */
#define BRAKE_MORE_CYCLES 400.0

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

double takt_rate_second(const struct rate *r, double to, double room, double landing, double most)
{
    const double sign = to > r->now ? 1.0 : -1.0;
    const double way = maths_abs(to - r->now);
    const double wanted = maths_min(landing_change(way, sign * r->change, landing), most);

    return maths_clamp(sign * wanted - r->change, -room, room);
}

double takt_rate_change_by(struct rate *r, double second)
{
    const double before = r->now;

    r->now = maths_clamp(r->now + r->change + 0.5 * second, 0.0, 1.0);
    r->change += second;
    return 0.5 * (before + r->now) - second / 12.0;
}

double takt_rate_step(struct rate *r, double to)
{
    const struct rate_limits *l = &r->limits;
    const double high =
        maths_clamp(r->now + r->change + room_at(l, r->now), r->now, 1.0); /* within this cycle */
    const double room = room_at(l, high);
    const double landing = room_at(l, maths_max(high, to));

    TAKT_ASSERT(to >= 0.0 && to <= 1.0 && r->now >= 0.0 && r->now <= 1.0);
    if (rate_settles(r, to, landing)) {
        const double here = 0.5 * (r->now + to);

        takt_rate_set(r, to);
        return here;
    }
    return takt_rate_change_by(
        r, takt_rate_second(r, to, room, landing, l->change * (1.0 - l->kept * high * high)));
}

/* Along |r'| = L (1 - k r^2) the way from r to rest is -ln(1 - k r^2) / (2 L k). */
double takt_rate_brake_cycles(const struct rate *r)
{
    const double k = r->limits.kept;

    return -takt_maths_ln(1.0 - k) / (2.0 * r->limits.change * k) + BRAKE_MORE_CYCLES;
}

/* r^2 = (1 - exp(-2 L k cycles)) / k */
double takt_rate_highest(const struct rate *r, double cycles)
{
    const double k = r->limits.kept;
    const double way = cycles - BRAKE_MORE_CYCLES;

    TAKT_ASSERT(way > 0.0);
    return maths_min(maths_sqrt((1.0 - takt_maths_exp(-2.0 * r->limits.change * k * way)) / k),
                     1.0);
}
