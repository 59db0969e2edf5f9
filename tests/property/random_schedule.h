/*
 * Random machines, and random schedules of what an operator does: steps and ramps of the feed
 * override, holds, the rapid override; and beside these, single block, stops, waits at the ends of
 * blocks, and a reset.
 */
#ifndef TAKT_TESTS_RANDOM_SCHEDULE_H
#define TAKT_TESTS_RANDOM_SCHEDULE_H

#include "motion/motion.h"
#include "random_chain.h"

#include <string.h>

struct schedule {
    struct motion_operator now;
    double target;  /* of a ramp of the feed override */
    double change;  /* of it in a cycle */
    bool hold;      /* by the operator */
    uint64_t until; /* the next event */
    uint64_t free;  /* cycles since anything was held */
};

/*
 * A machine to try it on, with every law: its cycle; its axes. What is drawn in between is the
 * test's.
 */
static inline void schedule_random_control(struct chain *c, struct plan_limits *l)
{
    static const double cycles_s[] = {5e-4, 1e-3, 2e-3, 4e-3};

    memset(l, 0, sizeof(*l));
    l->axes = 7;
    l->cycle_s = cycles_s[(unsigned)chain_between(c, 0, 4)];
    l->chord_error_max_mm = chain_decades(c, -4, -2);
    l->profile = (enum ramp_profile)chain_between(c, 0, 3);
}

static inline void schedule_random_axes(struct chain *c, struct plan_limits *l)
{
    for (int i = 0; i < CHAIN_AXES; i++) {
        l->velocity_mm_s[i] = chain_decades(c, 1.3, 2.7);
        l->acceleration_mm_s2[i] = chain_decades(c, 2.3, 4.0);
        l->jerk_mm_s3[i] = chain_decades(c, 3.7, 6.0);
    }
}

/* Steps, ramps, holds, feed override 0, rapid override 0; then nothing for a while. */
static inline void schedule_next(struct schedule *s, struct chain *c, uint64_t cycle)
{
    const double what = chain_between(c, 0, 1);

    s->until = cycle + 1 + (uint64_t)chain_decades(c, 0, 2.8);
    s->hold = what < 0.15;
    s->now.hold = s->hold ? MOTION_HOLD_ASKED : MOTION_GOES;
    s->now.rapid_ratio = what > 0.9 ? 0.0 : chain_between(c, 0.01, 1.0);
    s->target = what > 0.8 && what < 0.9 ? 0.0 : chain_between(c, 0.01, 1.2);
    s->change = what > 0.5 ? 1.2 : chain_decades(c, -4, -1);
}

static inline void schedule_follow(struct schedule *s, struct chain *c, uint64_t cycle)
{
    if (cycle >= s->until) {
        schedule_next(s, c, cycle);
    }
    s->now.feed_ratio += maths_clamp(s->target - s->now.feed_ratio, -s->change, s->change);
    const bool held = s->hold || s->now.feed_ratio <= 0.0 || s->now.rapid_ratio <= 0.0;

    s->free = held ? 0 : s->free + 1;
}

enum single_use { SINGLE_SWITCHED, SINGLE_ON, SINGLE_OFF };

/* What the operator does beside overrides and holds. */
struct hands {
    struct chain chance;
    struct schedule schedule;
    enum single_use use;
    bool single, stop;
    uint64_t switch_at, stop_at; /* cycles of the next change */
    uint64_t waits_until;        /* held at the end of a block */
    uint64_t reset_at;           /* 0: never */
    bool reset;
};

/* h is all 0. */
static inline void hands_begin(struct hands *h, unsigned seed)
{
    h->chance.seed = UINT64_C(0xd1b54a32d192ed03) * seed;
    h->schedule.now = (struct motion_operator){.feed_ratio = 1.0, .rapid_ratio = 1.0};
    h->schedule.target = 1.0;
    if (chain_between(&h->chance, 0, 1) < 0.1) {
        h->reset_at = 1 + (uint64_t)chain_decades(&h->chance, 0.5, 3.5);
    }
}

static inline void hands_switch_single(struct hands *h, uint64_t cycle)
{
    if (h->use == SINGLE_SWITCHED && cycle >= h->switch_at) {
        h->single = h->switch_at > 0 ? !h->single : chain_between(&h->chance, 0, 1) < 0.2;
        h->switch_at = cycle + 1 + (uint64_t)chain_decades(&h->chance, 0, 2.8);
        h->schedule.free = 0;
    }
}

/* Before each cycle; h->schedule.now is what the operator wants in it. */
static inline void hands_follow(struct hands *h, struct motion *m)
{
    struct motion_operator *now = &h->schedule.now;
    const uint64_t cycle = m->cycles;

    if (h->use != SINGLE_ON) {
        schedule_follow(&h->schedule, &h->chance, cycle);
    }
    hands_switch_single(h, cycle);
    if (h->use != SINGLE_ON && cycle >= h->stop_at) {
        h->stop = h->stop_at > 0 && !h->stop && chain_between(&h->chance, 0, 1) < 0.2;
        h->stop_at = cycle + 1 + (uint64_t)chain_decades(&h->chance, 0, 2.5);
    }
    const bool stops = h->stop || cycle < h->waits_until;

    now->hold = stops ? MOTION_HOLDS : h->schedule.hold ? MOTION_HOLD_ASKED : MOTION_GOES;
    now->single_block = h->use == SINGLE_ON || h->single;
    h->schedule.free = stops ? 0 : h->schedule.free;
    if (h->reset_at > 0 && cycle >= h->reset_at && !h->reset && h->use != SINGLE_ON) {
        h->reset = true;
        takt_motion_end_here(m);
    }
}

/* At the end of a single block the service holds, until the operator goes on. */
static inline void hands_hold_at_end(struct hands *h, const struct motion *m,
                                     const struct cycle_record *record)
{
    if (h->use != SINGLE_OFF && record->landed && takt_motion_rests(m) &&
        h->schedule.now.single_block && chain_between(&h->chance, 0, 1) < 0.7) {
        h->waits_until = m->cycles + (uint64_t)chain_decades(&h->chance, 0, 2.3);
    }
}

#endif
