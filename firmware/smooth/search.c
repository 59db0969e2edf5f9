/* The search for a curve in the window: relaxed, timed and verified. */
#include "smooth/parts.h"

#include "base/assert.h"
#include "smooth/single.h"

/* Rounds of smoothing and timing a window. A chain's first one begins from nothing. */
#define ROUNDS       1
#define ROUNDS_FIRST 4

/* Sixteenths of the window's pieces that are kept each time. */
#define KEPT_SIXTEENTHS 9U

/* Smoothing aims at this part of the tolerance. */
#define AIM 0.90

/* And at this part of that each time that a piece leaves the tolerance. */
#define NARROWER 0.9

/* Times that a window is slowed down because a piece leaves the tolerance. */
#define ATTEMPTS 16

/*
 * A slower piece leaves the tolerance by at most this part of what it left it by before, or slower
 * is no help.
 */
#define NEARER 0.95f

/* aim: a part of the tolerance */
static void relax_and_locate(struct smooth *s, union smooth_scratch *scratch, double aim)
{
    takt_relax_window(&scratch->relax, &s->window, &s->route,
                      (double)s->route.part * aim * s->route.tolerance_mm);
    takt_window_locate(&s->window, &s->route);
}

/*
 * With all known of a longer route in the window, one of this many pieces is kept: the others slow
 * down to its end.
 */
#define BLIND_PART 2

/*
 * Pieces before one that leaves the tolerance that are tried again with it: what they begin with
 * binds it.
 */
#define MARGIN 12

static unsigned kept_most(const struct smooth *s)
{
    return s->window.capacity * KEPT_SIXTEENTHS / 16U;
}

/*
 * Pieces that should keep the tolerance: more than are kept, so that the next ones can do it as
 * well.
 */
static unsigned wanted(const struct smooth *s)
{
    const unsigned pieces = s->window.count - 3;
    const unsigned enough = kept_most(s) + MARGIN;

    TAKT_ASSERT(s->window.count > 3);
    return s->window.at_end || pieces < enough ? pieces : enough;
}

static void verified(struct smooth *s, struct verifier_verdict *v)
{
    takt_verifier_pieces(&s->window, &s->route, wanted(s), kept_most(s), &s->order, v);
}

/* Do this many pieces come to the end of the chain? */
bool takt_search_is_end(const struct smooth *s, unsigned pieces)
{
    return smooth_is_finished(s) && s->window.at_end && pieces == s->window.count - 3;
}

/* Pieces to keep when this many from the first on are good. */
static unsigned kept(const struct smooth *s, unsigned good)
{
    const struct window *w = &s->window;

    TAKT_ASSERT(good <= s->window.count);
    if (w->at_end && !smooth_is_finished(s)) {
        return good / BLIND_PART;
    }
    if (takt_search_is_end(s, good)) {
        return good;
    }
    if (good >= kept_most(s) + MARGIN) {
        return kept_most(s);
    }
    return good > MARGIN ? good - MARGIN : 0;
}

/*
 * The curve as it is, timed once more: where it does not keep the tolerance so, it stays as it was.
 */
static void time_last(struct smooth *s, union smooth_scratch *scratch, struct verifier_verdict *v)
{
    struct verifier_verdict again;

    takt_timing_again(&scratch->timing, &s->window, &s->route);
    takt_window_extend(&s->window, &s->route);
    takt_window_locate(&s->window, &s->route);
    verified(s, &again);
    if (again.good >= wanted(s)) {
        *v = again;
    } else {
        s->window = scratch->timing.window;
    }
}

/*
 * Where a piece leaves the tolerance, it is slowed down: the slower, the nearer the samples are to
 * each other and the curve to them. They aim nearer, too: beside samples that are fixed nothing is
 * slower. Where that brings it no nearer the curve would only come there later and later. A corner
 * that was left out is noticed some way behind it: it is slow where all was whole.
 */
static void slow_down(struct smooth *s, union smooth_scratch *scratch, struct verifier_verdict *v)
{
    float before_mm = SINGLE_INFINITY;
    double aim = AIM;

    TAKT_ASSERT(s->window.count > SMOOTH_FIXED);
    verified(s, v);
    for (unsigned i = 0; i < ATTEMPTS && v->good < wanted(s); i++) {
        if (v->beyond_mm > NEARER * before_mm) {
            break;
        }
        before_mm = v->beyond_mm > 0.0f ? v->beyond_mm : SINGLE_INFINITY;
        aim *= NARROWER;
        takt_timing_slow(&scratch->timing, &s->window, &s->route, v->whole[v->good]);
        takt_window_extend(&s->window, &s->route);
        relax_and_locate(s, scratch, aim);
        verified(s, v);
    }
}

/* Does no way lead on? */
bool takt_search_is_stuck(const struct smooth *s)
{
    return s->ready == 0 || (s->proved == 0 && !takt_search_is_end(s, s->ready));
}

/* What is asked of a curve and of the path. */
struct worth_window takt_search_asked(const struct smooth *s, union smooth_scratch *scratch)
{
    return (struct worth_window){.of = s,
                                 .work = &scratch->worth,
                                 .pieces = s->ready + s->proved,
                                 .kept = s->ready,
                                 .begin_s =
                                     s->head.proved == 0 ? (float)takt_smooth_rest_s(s) : 0.0f};
}

/*
 * What comes well before a piece that leaves the tolerance is kept, the rest is tried again with
 * the next window.
 */
static void search_way(struct smooth *s, union smooth_scratch *scratch, unsigned rounds,
                       struct verifier_verdict *v)
{
    for (unsigned i = 0; i < rounds; i++) {
        relax_and_locate(s, scratch, AIM);
        takt_timing_again(&scratch->timing, &s->window, &s->route);
        takt_window_extend(&s->window, &s->route);
    }
    relax_and_locate(s, scratch, AIM);
    slow_down(s, scratch, v);
    time_last(s, scratch, v);
    const unsigned good = v->whole[v->good];

    s->ready = v->whole[kept(s, good)];
    s->proved = good - s->ready;
}

void takt_search_anew(struct smooth *s, union smooth_scratch *scratch, struct verifier_verdict *v)
{
    s->window.count = SMOOTH_FIXED;
    s->window.at_end = false;
    takt_window_extend(&s->window, &s->route);
    search_way(s, scratch, ROUNDS_FIRST, v);
}

/*
 * In motion it begins with what was found before; where no way leads on from that, one is looked
 * for from nothing.
 */
void takt_search_on(struct smooth *s, union smooth_scratch *scratch, struct verifier_verdict *v)
{
    search_way(s, scratch, ROUNDS, v);
    if (takt_search_is_stuck(s)) {
        takt_search_anew(s, scratch, v);
    }
}

void takt_search_follow(struct smooth *s, const struct verifier_verdict *v)
{
    TAKT_ASSERT(s->ready > 0 && s->ready + 1 < s->window.count);
    if (s->ready == v->followed && !takt_search_is_stuck(s)) {
        s->order = v->order;
    } else {
        takt_verifier_order(&s->window, &s->route, s->ready, &s->order);
    }
    if (s->order.count == 0) {
        takt_order_start(&s->order, s->window.at_mm[s->ready + 1], s->window.element[s->ready + 1]);
    }
}
