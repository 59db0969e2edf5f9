/*
 * The trapezoidal reference alone, under ceilings made by hand: no path, no blocks.
 *
 * A ceiling is laid of stretches, each for the setpoint from one place to the next, as spans.md
 * says: it begins for the trapezoidal reference feed (N - 1)/2 and two cycles earlier, never before
 * the one before it; a lower acceleration so much earlier by the highest feed, whatever the
 * override. Accelerations do not rise from one stretch to the next, so no stretch left behind asks
 * for less.
 */
#ifndef TAKT_TESTS_REFERENCE_BENCH_H
#define TAKT_TESTS_REFERENCE_BENCH_H

#include "base/maths.h"
#include "motion/average.h"
#include "motion/reference.h"
#include "plan/path.h"
#include "plan/path_unit.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

#define WINDOW 20
#define BEHIND (0.5 * (WINDOW - 1.0) + CEILING_MARGIN_CYCLES)

/*
 * s, mm/cycle, mm/cycle2: 100 mm/s and 1 m/s2 as ceilings keep it: of single precision, and not
 * above.
 */
#define CYCLE_S 1e-3
#define FEED    0.1
#define A       0x1.0624dcp-10

/*
 * The last change of feed to rest may be more than a by this part; positions are rounded to units.
 */
#define CHANGE_PART 3e-4

struct stretch {
    double length_mm;
    double feed;
    double a;
};

static struct reference reference;
static struct average average;
static struct ceiling ceilings[2];
static struct path paths[2]; /* each ceiling's: a block for each stretch */
static unsigned active;
static uint64_t setpoint;
static uint64_t cycles;

void setUp(void)
{
    takt_reference_init(&reference, RAMP_PROFILE_JERK, 0);
    takt_average_start(&average, RAMP_PROFILE_JERK, 1, 0, 0);
    active = 0;
    setpoint = 0;
    cycles = 0;
}

void tearDown(void)
{
}

static inline double square(double x)
{
    return x * x;
}

static inline float single_feed(double feed)
{
    return takt_maths_float_below(feed / CYCLE_S);
}

/* The block of a stretch, at the end of the ceiling's path. */
static inline void push_block(const struct ceiling *c, double feed, double from_mm, double end_mm)
{
    struct path *path = &paths[c - ceilings];

    path->ring.block[path->pushed] = (struct path_block){.start = path_units(from_mm),
                                                         .feed_program_mm_s = single_feed(feed),
                                                         .feed_limit_mm_s = single_feed(feed),
                                                         .cycles = WINDOW};
    path->pushed++;
    path->position = path_units(end_mm);
}

/* A piece up to a place, of a feed that the setpoint leaves with block leave - 1. */
static inline void append_piece(struct ceiling *c, double end_mm, float feed_mm_s, double a,
                                unsigned leave)
{
    c->end_mm[c->count] = end_mm;
    c->piece[c->count++] = (struct ceiling_piece){
        .feed_mm_s = feed_mm_s,
        .acceleration = takt_maths_float_below(a),
        .start = c->path->pushed & 0x1ffU,
        .leave = leave & 0x1ffU,
        .landing = CEILING_NONE,
        .opens = true,
    };
}

static inline void append(struct ceiling *c, const struct stretch *s, double ratio, double from_mm)
{
    const double feed = ratio * s->feed;
    const double end_mm = from_mm + s->length_mm;
    const double before_mm = c->count > 1 ? c->end_mm[c->count - 2] : 0.0;
    const double begin_mm = maths_max(before_mm, from_mm - feed * BEHIND);
    const double early_mm = maths_max(before_mm, from_mm - s->feed * BEHIND);
    const unsigned block = c->path->pushed;
    const struct ceiling_piece *last = c->count > 0 ? &c->piece[c->count - 1] : NULL;

    for (uint32_t k = c->count; k-- > 0 && c->end_mm[k] > begin_mm;) {
        c->end_mm[k] = begin_mm;
    }
    if (last != NULL && early_mm < begin_mm && s->a < (double)last->acceleration) {
        c->end_mm[c->count - 1] = early_mm;
        append_piece(c, begin_mm, last->feed_mm_s, s->a, last->leave);
    }
    append_piece(c, end_mm, single_feed(feed), s->a, block + 1);
    push_block(c, s->feed, from_mm, end_mm);
}

/* sqrt(min(c^2, u + 2 a L)) */
static inline float feed_before(const struct ceiling_piece *p, float feed_mm_s, float end_mm_s,
                                double length_mm)
{
    const double u = square((double)end_mm_s * CYCLE_S) + 2.0 * (double)p->acceleration * length_mm;

    return u < square((double)feed_mm_s * CYCLE_S) ? single_feed(maths_sqrt(u)) : feed_mm_s;
}

/* Backwards from rest, as the overrides are and at their highest. */
static inline void plan(struct ceiling *c)
{
    float feed_mm_s = 0.0F;
    float max_mm_s = 0.0F;

    for (uint32_t k = c->count; k-- > 0;) {
        struct ceiling_piece *p = &c->piece[k];
        const double length_mm = c->end_mm[k] - (k > 0 ? c->end_mm[k - 1] : 0.0);

        p->end_feed_mm_s = feed_mm_s;
        p->end_feed_max_mm_s = p->end == CEILING_LANDS ? p->feed_mm_s : max_mm_s;
        feed_mm_s = feed_before(p, p->feed_mm_s, feed_mm_s, length_mm);
        max_mm_s = feed_before(p, takt_ceiling_top_feed(c, k), max_mm_s, length_mm);
    }
}

/*
 * The stretches up to a stop at the end of the last, or without stops to the end of what is known.
 */
static inline void lay(struct ceiling *c, const struct stretch *s, unsigned count, double ratio,
                       bool stops)
{
    double at_mm = 0.0;

    memset(c, 0, sizeof(*c));
    c->path = &paths[c - ceilings];
    paths[c - ceilings].pushed = 0;
    c->cycle_s = CYCLE_S;
    for (unsigned i = 0; i < count; i++) {
        append(c, &s[i], ratio, at_mm);
        at_mm += s[i].length_mm;
    }
    c->piece[c->count - 1].end = stops ? CEILING_STOPS : CEILING_GOES_ON;
    c->open_from = stops ? c->count : 0;
    plan(c);
}

/* Takes a new ceiling as motion does: the one in use stays as it is until then. */
static inline void take(const struct stretch *s, unsigned count, double ratio, bool stops)
{
    active = 1 - active;
    lay(&ceilings[active], s, count, ratio, stops);
    takt_reference_set_ceiling(&reference, &ceilings[active]);
    while (reference_take(&reference)) {
    }
}

static inline double at_mm(void)
{
    return path_mm(0, reference.at);
}

/* Where the setpoint is: the average of the trapezoidal reference. */
static inline void follow(void)
{
    takt_average_push(&average, reference.at);
    setpoint = reference.at - (uint64_t)average_lag(&average);
}

static inline void check_change(double before, double a_max)
{
    char message[120];
    const double change = maths_abs(reference.feed - before);

    (void)snprintf(message, sizeof(message), "cycle %llu at %.9f mm: %.9f after %.9f mm/cycle",
                   (unsigned long long)cycles, at_mm(), reference.feed, before);
    TEST_ASSERT_TRUE_MESSAGE(reference.feed >= 0.0, message);
    TEST_ASSERT_TRUE_MESSAGE(change <= a_max * (1.0 + CHANGE_PART), message);
}

/* One cycle; the feed changes by no more than a_max. */
static inline void step(bool hold, double a_max)
{
    struct reference_start start;
    const double before = reference.feed;

    if (takt_reference_step(&reference, setpoint, hold, &start)) {
        takt_average_start(&average, RAMP_PROFILE_JERK, reference.cycles, start.at, start.step);
    }
    follow();
    cycles++;
    check_change(before, a_max);
}

static inline void run_to_stop(double a_max, unsigned cycles_max)
{
    takt_reference_release(&reference);
    for (unsigned i = 0; i < cycles_max; i++) {
        step(false, a_max);
        if (reference_stands(&reference)) {
            return;
        }
    }
    TEST_FAIL_MESSAGE("does not come to the stop");
}

static const struct stretch dip[] = {{20.0, FEED, A}, {5.0, 0.3 * FEED, A}, {20.0, FEED, A}};

/*
 * A junction that is landed on at feed, with the room before it that it needs, and a span behind
 * it.
 */
static inline void lay_junction(struct ceiling *c, double feed)
{
    const struct stretch after = {10.0, FEED, A};
    const double room_mm = feed * (0.5 * (WINDOW + 1.0) + 8.0);

    lay(c, &after, 1, 1.0, false);
    c->piece[1] = c->piece[0];
    c->end_mm[0] = 10.0 - room_mm;
    c->piece[1].feed_mm_s = single_feed(feed);
    c->piece[1].start = c->piece[0].leave;
    c->piece[1].end = CEILING_LANDS;
    c->count = 2;
    append(c, &after, 1.0, 10.0);
    c->end_mm[1] = 10.0;
    c->piece[2].end = CEILING_STOPS;
    c->open_from = c->count;
    plan(c);
    for (unsigned k = 0; k < 2; k++) {
        c->piece[k].landing = 1;
    }
}

#endif
