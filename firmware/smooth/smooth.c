#include "smooth/smooth.h"

#include "base/assert.h"
#include "smooth/exact.h"
#include "smooth/fill.h"
#include "smooth/head.h"
#include "smooth/piece.h"
#include "smooth/single.h"
#include "smooth/worth.h"

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

/* What a microcontroller is ready to give for smoothing. */
_Static_assert(sizeof(struct smooth) + sizeof(union smooth_scratch) <= 27UL * 1024UL,
               "too much memory");

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
static bool is_end(const struct smooth *s, unsigned pieces)
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
    if (is_end(s, good)) {
        return good;
    }
    if (good >= kept_most(s) + MARGIN) {
        return kept_most(s);
    }
    return good > MARGIN ? good - MARGIN : 0;
}

/*
 * No way on has been found in motion, or none that is worth it: what was proved the last time is
 * gone to its end, and come to rest there.
 */
static void fall_back(struct smooth *s)
{
    TAKT_ASSERT(s->head.proved > 0);
    s->ready = s->head.proved;
    s->proved = 0;
    s->stops = true;
    takt_head_take(&s->head, &s->window, &s->route);
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

/*
 * The order goes on to the end of what is handed on; where the axes went back to the route it
 * begins there.
 */
static void follow_ready(struct smooth *s, const struct verifier_verdict *v)
{
    TAKT_ASSERT(s->ready > 0 && s->ready + 1 < s->window.count);
    if (s->ready == v->followed && !s->stops) {
        s->order = v->order;
    } else {
        takt_verifier_order(&s->window, &s->route, s->ready, &s->order);
    }
    if (s->order.count == 0) {
        takt_order_start(&s->order, s->window.at_mm[s->ready + 1], s->window.element[s->ready + 1]);
    }
}

/* The path itself is taken from where the axes rest: to that place at least. */
static void take_path(struct smooth *s, double to_mm)
{
    TAKT_ASSERT(s->head.proved == 0);
    s->exact = true;
    s->exact_mm = to_mm;
    s->ready = 0;
    s->proved = 0;
    s->window.count = SMOOTH_FIXED;
    s->window.at_end = false;
}

/* Does no way lead on? */
static bool is_stuck(const struct smooth *s)
{
    return s->ready == 0 || (s->proved == 0 && !is_end(s, s->ready));
}

/* What is asked of a curve and of the path. */
static struct worth_window asked(const struct smooth *s, union smooth_scratch *scratch)
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

/* From rest every way is open: is the path itself the quicker, or the only one? to_mm: to there. */
static bool prefers_path(const struct smooth *s, union smooth_scratch *scratch, double *to_mm)
{
    const struct worth_window now = asked(s, scratch);
    struct worth_since since = s->since;

    return takt_worth_path_from_rest(&now, to_mm) || takt_worth_path(&now, &since) || is_stuck(s);
}

/*
 * Whether the window goes on. Where it does not, or the path itself is quicker, what was proved
 * last is gone to its end; and from rest, where every way is open again, the path itself is taken.
 */
static void choose(struct smooth *s, union smooth_scratch *scratch)
{
    const struct worth_window now = asked(s, scratch);
    double to_mm;
    const bool path = now.starts && prefers_path(s, scratch, &to_mm);
    const bool slower = takt_worth_path(&now, &s->since);

    if (path) {
        take_path(s, to_mm);
    } else if (!now.starts && (is_stuck(s) || slower)) {
        fall_back(s);
    }
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
static void search_on(struct smooth *s, union smooth_scratch *scratch, struct verifier_verdict *v)
{
    search_way(s, scratch, ROUNDS, v);
    if (is_stuck(s)) {
        search_anew(s, scratch, v);
    }
}

/*
 * How long the curve that was found seems to take to the end of what is known, by its time up to
 * until_mm, or to the end of its pieces if that is sooner: there until_mm is then.
 */
static float found_time(struct smooth *s, union smooth_scratch *scratch, double *until_mm)
{
    struct worth_window now = asked(s, scratch);

    if (is_stuck(s)) {
        return SINGLE_INFINITY;
    }
    while (now.pieces > 1 && s->window.at_mm[now.pieces + 1] > *until_mm) {
        now.pieces--;
    }
    *until_mm = s->window.at_mm[now.pieces + 1];
    return takt_worth_time(&now);
}

/* The time of the curve that is found in a part of the tolerance. */
static float try_within(struct smooth *s, union smooth_scratch *scratch, float part,
                        double *until_mm, struct verifier_verdict *v)
{
    takt_fill_within(s, part);
    search_anew(s, scratch, v);
    return found_time(s, scratch, until_mm);
}

/* How much quicker a narrower one must be. */
static float worth_of_width(const struct smooth *s)
{
    return is_end(s, s->ready) ? 1.0f : CLEARLY;
}

/*
 * What is found in a part of the tolerance is within all of it, and often the quicker: so the
 * quickest is taken.
 */
static void search_from_rest(struct smooth *s, union smooth_scratch *scratch,
                             struct verifier_verdict *v)
{
    double until_mm = MATHS_INFINITY;
    float least = SINGLE_INFINITY;
    float best = 1.0f;
    float part = parts[0];

    for (unsigned i = 0; i < PARTS; i++) {
        const float time = try_within(s, scratch, parts[i], &until_mm, v);

        if (worth_of_width(s) * time < least) {
            least = time;
            best = parts[i];
        }
    }
    while (best <= part && part > PART_LEAST) {
        part *= 0.5f;
        const float time = try_within(s, scratch, part, &until_mm, v);

        if (time < worth_of_width(s) * least) {
            least = time;
            best = part;
        }
    }
    if (best < 1.0f) {
        (void)try_within(s, scratch, best, &until_mm, v);
    }
}

/* The window for the next pieces; false when more must be known first. */
static bool next_window(struct smooth *s, union smooth_scratch *scratch)
{
    const bool goes_on = s->proved > 0;
    struct verifier_verdict v;

    takt_head_keep(&s->head, &s->window, &s->route, s->proved);
    if (!takt_fill(s)) {
        return false;
    }
    if (goes_on) {
        search_on(s, scratch, &v);
    } else {
        search_from_rest(s, scratch, &v);
    }
    choose(s, scratch);
    if (s->ready > 0) {
        follow_ready(s, &v);
    }
    return true;
}

/* Pieces that have been taken leave the window, elements that they have passed the route. */
static void drop_taken(struct smooth *s)
{
    TAKT_ASSERT(s->taken == s->ready);
    takt_window_drop(&s->window, &s->route, s->taken);
    s->taken = 0;
    s->ready = 0;
    if (s->stops) {
        takt_window_rest(&s->window, &s->route, &s->order);
        s->stops = false;
        takt_fill_begin_anew(s);
    }
    if (s->window.count > 0) {
        takt_route_forget(&s->route, s->window.at_mm[0]);
    }
}

/* Where the path has come to the end of an element. It is left where it rests. */
static void end_element(struct smooth *s)
{
    struct window *w = &s->window;
    const uint32_t next = w->element[0] + 1;

    TAKT_ASSERT(w->element[0] < s->route.count);
    if (next == s->route.count) {
        takt_smooth_end(s);
        return;
    }
    for (unsigned i = 0; i < SMOOTH_FIXED; i++) {
        w->element[i] = next;
    }
    if (w->at_mm[0] < s->exact_mm || !takt_exact_rests(&s->route, &s->limits, next)) {
        return;
    }
    s->exact = false;
    s->tried_mm = w->at_mm[0];
    s->tried = next;
    s->since = (struct worth_since){.element = next};
    takt_order_start(&s->order, w->at_mm[0], next);
    takt_fill_begin_anew(s);
}

/*
 * The next motion of the path itself; false: the axes are at its end. One before that which has
 * been told is a part of that: line and number never go back.
 */
static bool take_motion(struct smooth *s, struct smooth_piece *piece, struct curve *curve)
{
    const uint32_t element = s->window.element[0];
    const uint32_t told = takt_smooth_tell(s, element);
    const bool goes = takt_exact_next(&s->window, &s->route, &s->move, curve);
    const bool ends = s->window.at_mm[0] >= route_end_of(&s->route, element);

    TAKT_ASSERT(s->exact);
    s->move.line = route_element(&s->route, told)->line;
    piece->move = &s->move;
    piece->number = route_element(&s->route, told)->number;
    piece->starts = s->starts;
    s->starts = s->starts && !goes;
    piece->continues = !ends || told != element;
    if (ends) {
        end_element(s);
    }
    return goes;
}

static void take_piece(struct smooth *s, struct smooth_piece *piece)
{
    TAKT_ASSERT(s->taken < s->ready);
    takt_smooth_set_piece(s, piece);
    if (s->starts) {
        s->starts = false;
        takt_smooth_stand(s, piece, &piece->control[0], true);
        takt_smooth_take_standing(s, piece);
        return;
    }
    s->taken++;
    if (piece->last) {
        takt_smooth_stand(s, piece, &piece->control[3], false);
        piece->last = false;
    }
}

/* Is what the path does at the end of the element known? */
static bool is_element_known(const struct smooth *s)
{
    return s->finished || s->window.element[0] + 1 < s->route.count;
}

enum smooth_taken takt_smooth_take(struct smooth *s, union smooth_scratch *scratch,
                                   struct smooth_piece *piece, struct curve *curve)
{
    while (s->open) {
        if (s->stands) {
            takt_smooth_take_standing(s, piece);
            return SMOOTH_PIECE;
        }
        if (s->taken < s->ready) {
            take_piece(s, piece);
            return SMOOTH_PIECE;
        }
        drop_taken(s);
        if (!s->exact) {
            if (!next_window(s, scratch)) {
                return SMOOTH_NONE;
            }
        } else if (!is_element_known(s)) {
            return SMOOTH_NONE;
        } else if (take_motion(s, piece, curve)) {
            return SMOOTH_MOTION;
        }
    }
    return SMOOTH_NONE;
}
