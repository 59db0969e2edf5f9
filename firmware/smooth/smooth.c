#include "smooth/smooth.h"

#include "base/assert.h"
#include "smooth/exact.h"
#include "smooth/exact_time.h"
#include "smooth/head.h"
#include "smooth/parts.h"
#include "smooth/single.h"
#include "smooth/worth.h"

/* What a microcontroller is ready to give for smoothing. */
_Static_assert(sizeof(struct smooth) + sizeof(union smooth_scratch) <= 27UL * 1024UL,
               "too much memory");

/*
 * No way on has been found in motion, or none that is worth it: what was proved the last time is
 * gone to its end, and come to rest there.
 */
static void fall_back(struct smooth *s)
{
    TAKT_ASSERT(s->head.proved > 0);
    s->ready = s->head.proved;
    s->proved = 0;
    takt_head_take(&s->head, &s->window, &s->route);
}

/* The path itself is taken from where the axes rest: to that place at least. */
static void take_path(struct smooth *s, double to_mm)
{
    TAKT_ASSERT(s->head.proved == 0);
    s->exact_mm = to_mm;
    s->ready = 0;
    s->proved = 0;
    s->window.count = SMOOTH_FIXED;
    s->window.at_end = false;
}

/* From rest every way is open: the path itself is taken where it is quicker, or the only one. */
static void choose_from_rest(struct smooth *s, union smooth_scratch *scratch,
                             const struct worth_far *curve)
{
    const struct worth_window now = takt_search_asked(s, scratch);
    double to_mm;
    const bool quicker = takt_worth_path_from_rest(&now, curve, &to_mm);
    const bool slower = takt_worth_path(&now, &s->since);

    if (quicker || slower || takt_search_is_stuck(s)) {
        take_path(s, to_mm);
    }
}

/*
 * Where the window does not go on, or the path itself is quicker, what was proved last is gone to
 * its end.
 */
static void choose(struct smooth *s, union smooth_scratch *scratch)
{
    const struct worth_window now = takt_search_asked(s, scratch);
    const bool slower = takt_worth_path(&now, &s->since);

    if (takt_search_is_stuck(s) || slower) {
        fall_back(s);
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
        takt_search_on(s, scratch, &v);
        choose(s, scratch);
    } else {
        const struct worth_far curve = takt_trials_from_rest(s, scratch, &v);

        choose_from_rest(s, scratch, &curve);
    }
    if (s->ready > 0) {
        takt_search_follow(s, &v);
    }
    return true;
}

/* Pieces that have been taken leave the window, elements that they have passed the route. */
static void drop_taken(struct smooth *s)
{
    const bool stops = s->ready > 0 && takt_search_is_stuck(s);

    TAKT_ASSERT(s->taken == s->ready);
    takt_window_drop(&s->window, &s->route, s->taken);
    s->taken = 0;
    s->ready = 0;
    if (stops) {
        takt_window_rest(&s->window, &s->route, &s->order);
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
    s->exact_mm = SMOOTH_NOWHERE_MM;
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

    TAKT_ASSERT(s->exact_mm > SMOOTH_NOWHERE_MM);
    s->move.line = route_element(&s->route, told)->line;
    piece->move = &s->move;
    piece->number = route_element(&s->route, told)->number;
    piece->starts = s->standing == SMOOTH_STANDS_BEFORE;
    s->standing = goes ? SMOOTH_STANDS_NOT : s->standing;
    piece->continues = !ends || told != element;
    if (ends) {
        end_element(s);
    }
    return goes;
}

static bool has_piece(const struct smooth *s)
{
    return s->taken < s->ready || s->standing == SMOOTH_STANDS_BEHIND;
}

/* The axes stand before the first piece from rest, and behind the last one of the chain. */
static void take_piece(struct smooth *s, struct smooth_piece *piece)
{
    TAKT_ASSERT(has_piece(s));
    takt_smooth_set_piece(s, s->taken < s->ready ? s->taken : s->taken - 1, piece);
    if (s->standing != SMOOTH_STANDS_NOT) {
        takt_smooth_stand(s, piece);
        return;
    }
    s->taken++;
    if (piece->end == SMOOTH_ENDS) {
        s->standing = SMOOTH_STANDS_BEHIND;
        piece->end = SMOOTH_GOES_ON;
    }
}

/* Is what the path does at the end of the element known? */
static bool is_element_known(const struct smooth *s)
{
    return smooth_is_finished(s) || s->window.element[0] + 1 < s->route.count;
}

enum smooth_taken takt_smooth_take(struct smooth *s, union smooth_scratch *scratch,
                                   struct smooth_piece *piece, struct curve *curve)
{
    while (smooth_is_open(s)) {
        if (has_piece(s)) {
            take_piece(s, piece);
            return SMOOTH_PIECE;
        }
        drop_taken(s);
        if (s->exact_mm <= SMOOTH_NOWHERE_MM) {
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
