/*
 * Landing (seed 003 section 1, (1)-(4)). The source scales the whole diagram by kl = L / sum F(t) cycle; that scales the
 * end feeds too, and two blocks of different kl meet with a step. Here both end feeds are kept as planned as long as
 * possible and the time is stretched where the block cruises:
 *
 *     v |    ______            T*  = first cycle at or after the end of the fastest diagram
 *       |   /......\           1.  lower the cruise feed until the block lasts T*
 *       |  /        \          2.  if it then equals the higher end feed and the block is still too fast,
 *       | /          \             lower the end feed as well; the next block starts from there
 *       +--------------> t     3.  if even 0 is too fast, stop: rest can be held until the cycle comes
 *
 * Time grows without a jump along 1, 2, so a bisection finds T* to the last bit. A stop needs no stretching: the axes
 * are at rest when the cycle comes, and a path with bounded jerk in continuous time has bounded third differences.
 */
#include "plan/diagram.h"

#include "base/maths.h"

/* Enough to halve any interval of doubles met here down to its last bits. */
#define BISECTIONS 60

/* A duration this close to a whole number of cycles, in cycles, is one. */
#define CYCLE_SLACK 1e-9

/* Up to here every integer is a double. */
#define CYCLES_MAX 9007199254740992.0

static double ramps_length(const struct block *b, const struct diagram *d)
{
    return ramp_length(d->feed_start_mm_s, d->feed_cruise_mm_s, &b->ramp) +
           ramp_length(d->feed_cruise_mm_s, d->feed_end_mm_s, &b->ramp);
}

/* Length left for cruising between the ramps; negative: they do not fit. */
static double cruise_length(const struct block *b, const struct diagram *d)
{
    return b->length_mm - ramps_length(b, d);
}

/*
 * Ramps that fill their block are a little longer than it, by the rounding of their feeds (block.c, FEED_SLACK). Run k
 * times as long, k = L / length of the ramps, they keep their feeds and end at L: a / k, j / k^2.
 */
static double ramps_time_ratio(const struct block *b, const struct diagram *d)
{
    const double ramps_mm = ramps_length(b, d);

    return ramps_mm > b->length_mm ? b->length_mm / ramps_mm : 1.0;
}

struct diagram diagram_fastest(const struct block *b, double start_mm_s, double end_mm_s)
{
    struct diagram d = {start_mm_s, b->feed_max_mm_s, end_mm_s};
    double low = maths_max(start_mm_s, end_mm_s);
    double high = b->feed_max_mm_s;

    if (high <= low || cruise_length(b, &d) >= 0.0) {
        d.feed_cruise_mm_s = maths_max(low, high);
        return d;
    }
    if (start_mm_s == end_mm_s) {
        d.feed_cruise_mm_s = ramp_reach(low, 0.5 * b->length_mm, &b->ramp);
        return d;
    }
    for (int i = 0; i < BISECTIONS; i++) {
        d.feed_cruise_mm_s = 0.5 * (low + high);
        if (cruise_length(b, &d) >= 0.0) {
            low = d.feed_cruise_mm_s;
        } else {
            high = d.feed_cruise_mm_s;
        }
    }
    d.feed_cruise_mm_s = low;
    return d;
}

double diagram_duration(const struct block *b, const struct diagram *d)
{
    const double cruise_mm = maths_max(0.0, cruise_length(b, d));
    const double ramps_s =
        ramp_duration(maths_abs(d->feed_cruise_mm_s - d->feed_start_mm_s), &b->ramp) +
        ramp_duration(maths_abs(d->feed_cruise_mm_s - d->feed_end_mm_s), &b->ramp);

    return ramps_s * ramps_time_ratio(b, d) + cruise_mm / d->feed_cruise_mm_s;
}

/* A count of cycles >= 0 as an integer. No program lasts as long as the largest: 2^53 cycles are 28,000 years. */
static uint64_t whole_cycles(double cycles)
{
    return (uint64_t)maths_clamp(cycles, 0.0, CYCLES_MAX);
}

/* Cycles up to and including the first at or after the end. */
static uint64_t cycles_to_end(double duration_s, double phase_s, double cycle_s)
{
    return whole_cycles(maths_ceil((duration_s - phase_s) / cycle_s - CYCLE_SLACK)) + 1U;
}

uint64_t diagram_wait(double duration_s, double cycle_s)
{
    return whole_cycles(maths_ceil(duration_s / cycle_s - CYCLE_SLACK));
}

struct diagram_cycles diagram_pass(double duration_s, double phase_s, double cycle_s)
{
    struct diagram_cycles c = {0, phase_s, phase_s - duration_s};

    if (duration_s >= phase_s) {
        c.count = whole_cycles((duration_s - phase_s) / cycle_s) + 1U;
        c.next_s = phase_s + (double)c.count * cycle_s - duration_s;
    }
    c.next_s = maths_clamp(c.next_s, 0.0, cycle_s);
    return c;
}

struct diagram_cycles diagram_rest(double duration_s, double phase_s, double cycle_s)
{
    return (struct diagram_cycles){cycles_to_end(duration_s, phase_s, cycle_s), phase_s, cycle_s};
}

/* Step 1: the cruise feed, not below the end feeds, at which the block lasts target_s. */
static void stretch_cruise(const struct block *b, struct diagram *d, double target_s)
{
    double slow = maths_max(d->feed_start_mm_s, d->feed_end_mm_s);
    double fast = d->feed_cruise_mm_s;

    for (int i = 0; i < BISECTIONS; i++) {
        d->feed_cruise_mm_s = 0.5 * (slow + fast);
        if (diagram_duration(b, d) >= target_s) {
            slow = d->feed_cruise_mm_s;
        } else {
            fast = d->feed_cruise_mm_s;
        }
    }
    d->feed_cruise_mm_s = slow;
}

/* The slowest diagram to an end feed. */
static struct diagram diagram_slowest(double start_mm_s, double end_mm_s)
{
    return (struct diagram){start_mm_s, maths_max(start_mm_s, end_mm_s), end_mm_s};
}

/* Step 2: the end feed at which the slowest diagram lasts target_s. */
static void stretch_end(const struct block *b, struct diagram *d, double target_s)
{
    double slow = 0.0;
    double fast = d->feed_end_mm_s;

    for (int i = 0; i < BISECTIONS; i++) {
        const double middle = 0.5 * (slow + fast);

        *d = diagram_slowest(d->feed_start_mm_s, middle);
        if (diagram_duration(b, d) >= target_s) {
            slow = middle;
        } else {
            fast = middle;
        }
    }
    *d = diagram_slowest(d->feed_start_mm_s, slow);
}

bool diagram_land(const struct block *b, struct diagram *d, double phase_s, double cycle_s)
{
    const uint64_t cycles = cycles_to_end(diagram_duration(b, d), phase_s, cycle_s);
    const double target_s = phase_s + (double)(cycles - 1U) * cycle_s;
    const struct diagram slowest = diagram_slowest(d->feed_start_mm_s, d->feed_end_mm_s);
    struct diagram stop;

    if (diagram_duration(b, &slowest) >= target_s) {
        stretch_cruise(b, d, target_s);
        return true;
    }
    stop = diagram_slowest(d->feed_start_mm_s, 0.0);
    if (d->feed_start_mm_s == 0.0 || diagram_duration(b, &stop) >= target_s) {
        stretch_end(b, d, target_s);
        return true;
    }
    *d = diagram_fastest(b, d->feed_start_mm_s, 0.0);
    return false;
}

void diagram_expand(const struct block *b, const struct diagram *d, struct profile *p)
{
    const double cruise_mm = maths_max(0.0, cruise_length(b, d));
    const double k = ramps_time_ratio(b, d);
    const struct ramp_limits ramp = {b->ramp.a_mm_s2 / k, b->ramp.j_mm_s3 / (k * k)};
    double s;

    p->duration_s = 0.0;
    p->count = 0;
    p->feed_start_mm_s = d->feed_start_mm_s;
    p->feed_cruise_mm_s = d->feed_cruise_mm_s;
    p->feed_end_mm_s = d->feed_end_mm_s;
    s = ramp_append(p, 0.0, d->feed_start_mm_s, d->feed_cruise_mm_s, &ramp);
    if (cruise_mm > 0.0) {
        const struct profile_state at = {s, d->feed_cruise_mm_s, 0.0};

        s = profile_append(p, at, cruise_mm / d->feed_cruise_mm_s, 0.0).s_mm;
    }
    ramp_append(p, s, d->feed_cruise_mm_s, d->feed_end_mm_s, &ramp);
}
