/*
 * The search for the fastest chain: differential evolution (a population of candidates that
 * recombines and keeps what is better) over both junctions. The best is often at the edge of what
 * can be done at all, so the state at a junction is not only given as such, but also by the phases
 * that lead to it, from the start, from the other junction, or from the end backwards.
 */
#include "optimum.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#define PARAMETERS  4
#define POPULATION  24
#define GENERATIONS 80

/* How the states at the junctions are found of the parameters. */
enum first_junction { FIRST_GIVEN, FIRST_BY_PHASES, FIRST_WAYS };
enum second_junction { SECOND_GIVEN, SECOND_BY_PHASES, SECOND_FROM_END, SECOND_WAYS };

struct family {
    struct optimum_move chain[OPTIMUM_MOVES];
    enum first_junction first;
    enum second_junction second;
};

struct candidate {
    double x[PARAMETERS]; /* 0 to 1 */
    double time;
};

struct search {
    uint64_t seed;
    struct candidate candidate[POPULATION];
};

static const struct optimum_state rest = {0.0, 0.0};

/*
 * The highest feed to which a way from rest leads: by full acceleration, and by full jerk,
 * v^3 = 9/2 j s^2.
 */
static double feed_after(const struct optimum_move *m)
{
    const double way = m->length;

    return fmin(sqrt(2.0 * m->acceleration * way), cbrt(4.5 * m->jerk * way * way));
}

/*
 * A state at the junction between two moves: a part of the highest feed, and of the acceleration
 * that leaves both limits.
 */
static struct optimum_state state_given(const struct optimum_move *before, double feed_max,
                                        const double x[2])
{
    const struct optimum_move *after = before + 1;
    const double most =
        fmin(fmin(before->junction_feed, feed_max), fmin(before->feed, after->feed));
    const double feed = x[0] * most;
    const double part = 2.0 * x[1] - 1.0;
    const struct optimum_move *const beyond = part > 0.0 ? after : before;
    const double jerk = fmin(before->jerk, after->jerk);
    const double a = fmin(fmin(before->acceleration, after->acceleration), sqrt(2.0 * jerk * feed));

    return (struct optimum_state){
        feed, part * fmin(a, sqrt(2.0 * beyond->jerk * (optimum_level(beyond) - feed)))};
}

/* A time in which the move can be passed, and not much longer than it takes. */
static double time_scale(const struct optimum_move *m, double feed)
{
    const double from_rest = cbrt(6.0 * m->length / m->jerk) +
                             sqrt(2.0 * m->length / m->acceleration) + m->length / m->feed;

    return fmin(m->length / fmax(feed, 1e-6), from_rest);
}

/*
 * Passes a move by two parameters: the first one's sign and duration, and the second one's
 * duration.
 */
static double pass(const struct optimum_move *m, struct optimum_state *state, bool from_rest,
                   const double x[2])
{
    const double scale = time_scale(m, state->feed);
    const double first = from_rest ? x[0] : 2.0 * x[0] - 1.0;
    const struct optimum_phases phases = {
        first < 0.0 ? -1.0 : 1.0, {fabs(first) * scale, x[1] * scale}, 8.0 * scale};
    double time;

    return optimum_pass(m, &phases, state, &time) ? time : HUGE_VAL;
}

static bool may_join(const struct optimum_move *before, const struct optimum_state *state)
{
    return state->feed <= before->junction_feed && optimum_may_be(before, state) &&
           optimum_may_be(before + 1, state);
}

static double first_junction(const struct family *f, const double x[2], struct optimum_state *one)
{
    *one = rest;
    if (f->first == FIRST_BY_PHASES) {
        return pass(&f->chain[0], one, true, x);
    }
    *one = state_given(&f->chain[0], feed_after(&f->chain[0]), x);
    return optimum_between(&f->chain[0], &rest, one);
}

/* From the first junction to the end. */
static double second_junction(const struct family *f, const double x[2],
                              const struct optimum_state *one)
{
    const struct optimum_move *const chain = f->chain;
    struct optimum_state two = rest;
    double last_s;

    if (f->second == SECOND_BY_PHASES) {
        two = *one;
        const double middle_s = pass(&chain[1], &two, false, x);

        return may_join(&chain[1], &two) ? middle_s + optimum_between(&chain[2], &two, &rest)
                                         : HUGE_VAL;
    }
    if (f->second == SECOND_FROM_END) {
        last_s = pass(&chain[2], &two, true, x);
        two.acceleration = -two.acceleration;
    } else {
        two = state_given(&chain[1], feed_after(&chain[2]), x);
        last_s = optimum_between(&chain[2], &two, &rest);
    }
    return may_join(&chain[1], &two) ? last_s + optimum_between(&chain[1], one, &two) : HUGE_VAL;
}

static double time_of(const struct family *f, const double x[PARAMETERS])
{
    struct optimum_state one;
    const double first_s = first_junction(f, x, &one);

    return first_s < HUGE_VAL && may_join(&f->chain[0], &one)
               ? first_s + second_junction(f, x + 2, &one)
               : HUGE_VAL;
}

/* -- the search -- */

static double any(struct search *s)
{
    s->seed = s->seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(s->seed >> 11) / 9007199254740992.0;
}

/* Spread over all, and some at the edges, where the best often is. */
static void start_search(struct search *s, const struct family *f)
{
    s->seed = 1;
    for (int i = 0; i < POPULATION; i++) {
        struct candidate *const c = &s->candidate[i];

        for (int k = 0; k < PARAMETERS; k++) {
            c->x[k] = any(s) < 0.3 ? floor(3.0 * any(s)) / 2.0 : any(s);
        }
        c->time = time_of(f, c->x);
    }
}

static const struct candidate *best_of(const struct search *s)
{
    int best = 0;

    for (int i = 1; i < POPULATION; i++) {
        best = s->candidate[i].time < s->candidate[best].time ? i : best;
    }
    return &s->candidate[best];
}

static const struct candidate *any_of(struct search *s)
{
    return &s->candidate[(int)(any(s) * POPULATION)];
}

/* A child of candidate i, moved by the difference of two others; kept if it is as fast. */
static void recombine(struct search *s, const struct family *f, int i)
{
    struct candidate *const parent = &s->candidate[i];
    const struct candidate *const one = any_of(s);
    const struct candidate *const two = any_of(s);
    const struct candidate *const base = any(s) < 0.5 ? best_of(s) : parent;
    const double step = 0.4 + 0.5 * any(s);
    struct candidate child = *parent;

    for (int k = 0; k < PARAMETERS; k++) {
        if (any(s) < 0.9) {
            child.x[k] = fmin(1.0, fmax(0.0, base->x[k] + step * (one->x[k] - two->x[k])));
        }
    }
    child.time = time_of(f, child.x);
    if (child.time <= parent->time) {
        *parent = child;
    }
}

static double search(const struct family *f)
{
    struct search s;

    start_search(&s, f);
    for (int generation = 0; generation < GENERATIONS; generation++) {
        for (int i = 0; i < POPULATION; i++) {
            recombine(&s, f, i);
        }
    }
    return best_of(&s)->time;
}

/*
 * A short move may be left while speed changes: it never gets where it would level off. v + a^2/2j
 * is the most.
 */
static void level_beyond(struct optimum_move chain[OPTIMUM_MOVES])
{
    for (int i = 0; i < OPTIMUM_MOVES; i++) {
        struct optimum_move *const m = &chain[i];

        m->level_feed = m->feed + 0.5 * m->acceleration * m->acceleration / m->jerk;
    }
}

static double search_all(const struct optimum_move chain[OPTIMUM_MOVES])
{
    double least = HUGE_VAL;

    for (int first = 0; first < FIRST_WAYS; first++) {
        for (int second = 0; second < SECOND_WAYS; second++) {
            struct family f = {{chain[0], chain[1], chain[2]},
                               (enum first_junction)first,
                               (enum second_junction)second};

            least = fmin(least, search(&f));
            level_beyond(f.chain);
            least = fmin(least, search(&f));
        }
    }
    return least;
}

/* The same the other way round takes the same time, and may be found where this is not. */
double optimum_chain(const struct optimum_move chain[OPTIMUM_MOVES])
{
    struct optimum_move back[OPTIMUM_MOVES] = {chain[2], chain[1], chain[0]};

    back[0].junction_feed = chain[1].junction_feed;
    back[1].junction_feed = chain[0].junction_feed;
    return fmin(search_all(chain), search_all(back));
}
