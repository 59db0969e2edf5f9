/* The search for a curve in the window: relaxed, timed, verified, and from rest in parts of P. */
#include "smooth/search.h"

#include "base/assert.h"
#include "base/maths.h"
#include "smooth/fill.h"
#include "smooth/piece.h"
#include "smooth/single.h"

/* Rounds of smoothing and timing a window. A chain's first one begins from nothing. */
#define ROUNDS       1
#define ROUNDS_FIRST 4

/* Sixteenths of the window's pieces that are kept each time. */
#define KEPT_SIXTEENTHS 9U

/* Smoothing aims at this part of the tolerance. */
#define AIM 0.90

/* From rest a curve is also looked for in narrower parts of the tolerance. */
#define PARTS 3U
static const float parts[PARTS] = {0.25f, 0.5f, 1.0f};

/* And in ever narrower ones as long as that is quicker. */
#define PART_LEAST (1.0f / 64.0f)

/* And at ever shorter intervals where the chain's end is in the window. */
#define FINE_LEAST (1.0f / 32.0f)
#define FINER      0.70710678f

/*
 * Where the chain goes on behind the window, a narrower one must be quicker by this: longer
 * intervals reach farther ahead.
 */
#define CLEARLY 0.85f

/* Times that a window is slowed down because a piece leaves the tolerance. */
#define ATTEMPTS 16

/*
 * A slower piece leaves the tolerance by at most this part of what it left it by before, or slower
 * is no help.
 */
#define NEARER 0.95f

static void relax_and_locate(struct smooth *s, union smooth_scratch *scratch)
{
    takt_relax_window(&scratch->relax, &s->window, &s->route,
                      (double)s->route.part * AIM * s->route.tolerance_mm);
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
    return s->finished && s->window.at_end && pieces == s->window.count - 3;
}

/* Pieces to keep when this many from the first on are good. */
static unsigned kept(const struct smooth *s, unsigned good)
{
    const struct window *w = &s->window;

    TAKT_ASSERT(good <= s->window.count);
    if (w->at_end && !s->finished) {
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
 * each other and the curve to them. Where that brings it no nearer the curve would only come there
 * later and later. A corner that was left out is noticed some way behind it: it is slow where all
 * was whole.
 */
static void slow_down(struct smooth *s, union smooth_scratch *scratch, struct verifier_verdict *v)
{
    float before_mm = SINGLE_INFINITY;

    TAKT_ASSERT(s->window.count > SMOOTH_FIXED);
    verified(s, v);
    for (unsigned i = 0; i < ATTEMPTS && v->good < wanted(s); i++) {
        if (v->beyond_mm > NEARER * before_mm) {
            break;
        }
        before_mm = v->beyond_mm > 0.0f ? v->beyond_mm : SINGLE_INFINITY;
        takt_timing_slow(&scratch->timing, &s->window, &s->route, v->whole[v->good]);
        takt_window_extend(&s->window, &s->route);
        relax_and_locate(s, scratch);
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
    return (struct worth_window){.window = &s->window,
                                 .route = &s->route,
                                 .machine = &s->limits,
                                 .change = &s->change,
                                 .pace = &scratch->pace,
                                 .pieces = s->ready + s->proved,
                                 .kept = s->ready,
                                 .rest_s = (float)takt_smooth_rest_s(s),
                                 .starts = s->head.proved == 0,
                                 .finished = s->finished};
}

/*
 * What comes well before a piece that leaves the tolerance is kept, the rest is tried again with
 * the next window.
 */
static void search_way(struct smooth *s, union smooth_scratch *scratch, unsigned rounds,
                       struct verifier_verdict *v)
{
    for (unsigned i = 0; i < rounds; i++) {
        relax_and_locate(s, scratch);
        takt_timing_again(&scratch->timing, &s->window, &s->route);
        takt_window_extend(&s->window, &s->route);
    }
    relax_and_locate(s, scratch);
    slow_down(s, scratch, v);
    time_last(s, scratch, v);
    s->ends = s->finished && s->window.at_end;
    const unsigned good = v->whole[v->good];

    s->ready = v->whole[kept(s, good)];
    s->proved = good - s->ready;
}

/* From nothing but what is kept. */
static void search_anew(struct smooth *s, union smooth_scratch *scratch, struct verifier_verdict *v)
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
        search_anew(s, scratch, v);
    }
}

/*
 * How long the curve that was found seems to take to the end of what is known, by its time up to
 * until_mm, or to the end of its pieces if that is sooner: there until_mm is then.
 */
static float found_time(struct smooth *s, union smooth_scratch *scratch, double *until_mm)
{
    struct worth_window now = takt_search_asked(s, scratch);

    if (takt_search_is_stuck(s)) {
        return SINGLE_INFINITY;
    }
    while (now.pieces > 1 && s->window.at_mm[now.pieces + 1] > *until_mm) {
        now.pieces--;
    }
    *until_mm = s->window.at_mm[now.pieces + 1];
    return takt_worth_time(&now);
}

/* A curve is looked for in a part of the tolerance, at so much of that one's interval. */
struct trial {
    float part;
    float fine;
};

/* What has been tried, and the quickest of it. */
struct trials {
    double until_mm; /* all are known to here */
    struct trial best;
    float least; /* its time */
    bool whole;  /* it comes to the end of the chain */
    float top;   /* the widest part that is of any use */
};

/* The time of the curve that is found so. */
static float try_one(struct smooth *s, union smooth_scratch *scratch, const struct trial *now,
                     double *until_mm, struct verifier_verdict *v)
{
    takt_fill_within(s, now->part, now->fine);
    search_anew(s, scratch, v);
    return found_time(s, scratch, until_mm);
}

/* Is one quicker than what was the quickest so far? A narrower one by so much. */
static bool is_quicker(struct smooth *s, union smooth_scratch *scratch, struct trial now,
                       struct trials *all, struct verifier_verdict *v)
{
    const float time = try_one(s, scratch, &now, &all->until_mm, v);
    const bool whole = takt_search_is_end(s, s->ready);
    const float margin = whole ? 1.0f : CLEARLY;
    const bool wider = now.part > all->best.part;

    if (wider ? margin * time >= all->least : time >= margin * all->least) {
        return false;
    }
    all->best = now;
    all->least = time;
    all->whole = whole;
    return true;
}

/* The same of a chain all of which is in the window. */
static bool is_quicker_whole(struct smooth *s, union smooth_scratch *scratch, struct trial now,
                             struct trials *all, struct verifier_verdict *v)
{
    double until_mm = MATHS_INFINITY;
    const float time = try_one(s, scratch, &now, &until_mm, v);

    if (!takt_search_is_end(s, s->ready) || time >= all->least) {
        return false;
    }
    all->best = now;
    all->least = time;
    return true;
}

/*
 * A chain that ends in the window may have so few samples that it takes the longer the farther they
 * are apart.
 */
static void search_finer(struct smooth *s, union smooth_scratch *scratch, struct trials *all,
                         struct verifier_verdict *v)
{
    const struct trial wide = {all->top, single_sqrt(all->best.part / all->top)};

    all->least = SINGLE_INFINITY;
    (void)is_quicker_whole(s, scratch, all->best, all, v);
    if (all->best.part < all->top) {
        (void)is_quicker_whole(s, scratch, wide, all, v);
    }
    while (all->best.fine > FINE_LEAST) {
        const struct trial finer = {all->best.part, FINER * all->best.fine};

        if (!is_quicker_whole(s, scratch, finer, all, v)) {
            return;
        }
    }
}

/*
 * What is found in a part of the tolerance is within all of it, and often the quicker: so the
 * quickest is taken.
 */
void takt_search_from_rest(struct smooth *s, union smooth_scratch *scratch,
                           struct verifier_verdict *v)
{
    const float top = takt_fill_useful(s);
    struct trials all = {MATHS_INFINITY, {top, 1.0f}, SINGLE_INFINITY, false, top};

    for (unsigned i = 0; i < PARTS; i++) {
        (void)is_quicker(s, scratch, (struct trial){top * parts[i], 1.0f}, &all, v);
    }
    for (float part = 0.5f * top * parts[0];
         all.best.part <= 2.0f * part && part >= top * PART_LEAST; part *= 0.5f) {
        (void)is_quicker(s, scratch, (struct trial){part, 1.0f}, &all, v);
    }
    if (all.whole) {
        search_finer(s, scratch, &all, v);
    }
    (void)try_one(s, scratch, &all.best, &all.until_mm, v);
}
