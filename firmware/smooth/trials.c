/*
 * From rest every way is open: curves are looked for in parts of the tolerance and at shorter
 * intervals, gone along window by window, and the quickest is taken.
 */
#include "smooth/parts.h"

#include "base/assert.h"
#include "base/maths.h"
#include "smooth/single.h"

#include <string.h>

/* The tolerance, a half and a quarter of it; and less as long as that is quicker. */
#define PART_TRIED (1.0f / 4.0f)
#define PART_LEAST (1.0f / 64.0f)

/*
 * And ever longer intervals, where the quickest comes to the chain's end; or shorter ones, where
 * that is in the first window.
 */
#define COARSE_MOST 4.0f
#define FINE_LEAST  (1.0f / 32.0f)
#define FINER       0.70710678f

/*
 * Windows that the quickest is gone along; the least part of the tolerance has a quarter of all of
 * its interval, or less.
 */
#define WINDOWS     5U
#define WINDOWS_ALL (4U * WINDOWS)

/* What is narrower or finer takes more planning: it must take this part of the time, or less. */
#define WORTH 0.995f

/* And this part, or less, a narrower one where more follows than is known: it stays for that. */
#define WORTH_AHEAD 0.97f

/* The chain's end, where the axes rest. */
#define AT_REST MATHS_INFINITY

/* A curve in a part of the tolerance, at so much of that one's interval. */
struct trial {
    float part;
    float fine;
};

/* The quickest so far. */
struct quickest {
    struct trial trial;
    struct worth_far far;
    bool whole; /* its first window comes to the end of what is known */
};

/* Where the axes rest. */
struct rest {
    double at[AXIS_COUNT];
    double at_mm;
    uint32_t element;
    struct order order;
};

/* How far a trial has come. */
struct going {
    float worth;      /* the part of the quickest one's time that it must take, or less */
    unsigned windows; /* behind it, */
    float spent_s;    /* and what they took, */
    float rate;       /* and that of nominal time there */
    double to_mm;     /* the place that it has come to; if it is as far as the quickest, as quick */
};

enum outcome { GOES_ON, SLOWER, QUICKER };

static void keep_rest(const struct smooth *s, struct rest *from)
{
    TAKT_ASSERT(s->window.count > 0);
    memcpy(from->at, s->window.origin, sizeof from->at);
    from->at_mm = s->window.at_mm[0];
    from->element = s->window.element[0];
    from->order = s->order;
}

static void begin(struct smooth *s, union smooth_scratch *scratch, const struct rest *from,
                  const struct trial *now, struct verifier_verdict *v)
{
    takt_window_stand(&s->window, &s->route, from->at, from->at_mm, from->element);
    s->order = from->order;
    takt_fill_within(s, now->part, now->fine);
    takt_search_anew(s, scratch, v);
}

/* The next window, as if what is ready had been taken. */
static void go_on(struct smooth *s, union smooth_scratch *scratch, struct verifier_verdict *v)
{
    TAKT_ASSERT(s->ready > 0);
    takt_search_follow(s, v);
    takt_window_drop(&s->window, &s->route, s->ready);
    takt_window_extend(&s->window, &s->route);
    takt_search_on(s, scratch, v);
}

/* What a window's pieces take to a place that they come to. */
static float time_to(struct worth_window now, float rate, double to_mm)
{
    struct worth_run run;

    while (to_mm < AT_REST && now.pieces > 1 && now.of->window.at_mm[now.pieces] >= to_mm) {
        now.pieces--;
    }
    now.kept = now.pieces;
    takt_worth_run(&now, rate, &run);
    return run.time_s;
}

/* Where it is as far as the quickest has come, it was quicker to there. */
static bool is_quicker(const struct going *g, const struct quickest *best)
{
    return g->to_mm >= best->far.to_mm;
}

/* The axes come to rest where no way leads on, and must get going again from there. */
static enum outcome stop(const struct smooth *s, const struct going *g, struct quickest *best)
{
    if (!is_quicker(g, best)) {
        return SLOWER;
    }
    best->far.to_mm = maths_max(best->far.to_mm, s->window.at_mm[1]);
    best->far.time_s = g->spent_s + 2.0f * (float)takt_smooth_rest_s(s);
    return QUICKER;
}

/* One window of a trial: all of it counts where no more is known behind it. */
static enum outcome judge(struct smooth *s, union smooth_scratch *scratch, struct going *g,
                          struct quickest *best)
{
    struct worth_window now = takt_search_asked(s, scratch);
    const bool ends = takt_search_is_end(s, s->ready);
    const bool last = ends || (s->window.at_end && !smooth_is_finished(s)) || s->proved == 0;
    const bool was_quicker = is_quicker(g, best);
    const double to_mm = ends ? AT_REST : s->window.at_mm[now.pieces + 1];
    struct worth_run run;

    now.begin_s = g->windows == 0 ? now.begin_s : 0.0f;
    g->to_mm = maths_max(g->to_mm, to_mm);
    if (!was_quicker && is_quicker(g, best) &&
        g->spent_s + time_to(now, g->rate, best->far.to_mm) >= g->worth * best->far.time_s) {
        return SLOWER;
    }
    g->windows++;
    if (is_quicker(g, best) && (last || g->windows >= WINDOWS)) {
        best->far.to_mm = maths_max(best->far.to_mm, last ? to_mm : s->window.at_mm[s->ready + 1]);
        best->far.time_s = g->spent_s + time_to(now, g->rate, best->far.to_mm);
        return QUICKER;
    }
    takt_worth_run(&now, g->rate, &run);
    g->spent_s += run.kept_s;
    g->rate = run.rate;
    return !is_quicker(g, best) &&
                   (last || g->spent_s > best->far.time_s || g->windows >= WINDOWS_ALL)
               ? SLOWER
               : GOES_ON;
}

/* Is this quicker than what was the quickest so far, to where that has come? */
static bool try_one(struct smooth *s, union smooth_scratch *scratch, const struct rest *from,
                    struct trial now, struct quickest *best, struct verifier_verdict *v)
{
    struct going g = {
        .worth = smooth_is_finished(s) || now.fine < 1.0f ? WORTH : WORTH_AHEAD,
        .rate = 1.0f,
        .to_mm = SMOOTH_NOWHERE_MM,
    };
    enum outcome outcome = GOES_ON;

    begin(s, scratch, from, &now, v);
    const bool whole = s->window.at_end;

    while (outcome == GOES_ON) {
        if (g.windows > 0) {
            go_on(s, scratch, v);
        }
        outcome = takt_search_is_stuck(s) ? stop(s, &g, best) : judge(s, scratch, &g, best);
    }
    if (outcome == QUICKER) {
        best->trial = now;
        best->whole = whole;
    }
    return outcome == QUICKER;
}

/* Many small corners, each of which is given its time, may be one wave. */
static bool try_coarser(struct smooth *s, union smooth_scratch *scratch, const struct rest *from,
                        struct quickest *best, struct verifier_verdict *v)
{
    struct trial coarser = {best->trial.part, best->trial.fine / FINER};
    bool found = false;

    while (coarser.fine <= COARSE_MOST && try_one(s, scratch, from, coarser, best, v)) {
        coarser.fine /= FINER;
        found = true;
    }
    return found;
}

/*
 * A chain that ends in the window may have so few samples that it takes the longer the farther they
 * are apart.
 */
static void try_finer(struct smooth *s, union smooth_scratch *scratch, const struct rest *from,
                      float top, struct quickest *best, struct verifier_verdict *v)
{
    struct trial finer = {top, single_sqrt(best->trial.part / top)};

    if (best->trial.part < top) {
        (void)try_one(s, scratch, from, finer, best, v);
    }
    do {
        finer = (struct trial){best->trial.part, FINER * best->trial.fine};
    } while (best->trial.fine > FINE_LEAST && try_one(s, scratch, from, finer, best, v));
}

/*
 * What is found in a part of the tolerance is within all of it, and often the quicker. The last
 * trial is the quickest once more.
 */
struct worth_far takt_trials_from_rest(struct smooth *s, union smooth_scratch *scratch,
                                       struct verifier_verdict *v)
{
    const float top = takt_fill_useful(s);
    struct quickest best = {.trial = {top, 1.0f}, .far = {s->window.at_mm[0], SINGLE_INFINITY}};
    struct rest from;

    keep_rest(s, &from);
    for (float part = top;
         part >= top * PART_TRIED || (part >= top * PART_LEAST && best.trial.part <= 2.0f * part);
         part *= 0.5f) {
        (void)try_one(s, scratch, &from, (struct trial){part, 1.0f}, &best, v);
    }
    const bool ends = best.far.to_mm >= AT_REST;

    if (!(ends && try_coarser(s, scratch, &from, &best, v)) && best.whole) {
        try_finer(s, scratch, &from, top, &best, v);
    }
    begin(s, scratch, &from, &best.trial, v);
    return best.far;
}
