#include "smooth/verifier.h"

#include "base/assert.h"
#include "smooth/chord.h"
#include "smooth/single.h"

#include <stddef.h>

/* Rounding of feeds that are the same. */
#define SAME 0.99999f

/* The places looked at are within this part of the tolerance, or less: within_of(). */
#define JUDGED 0.985f

/* Places looked at in a piece, at most. */
#define PLACES_MAX 8

/*
 * From one of a piece's control points to the next, weighted, and from its first one to its last.
 */
struct steps {
    lanes step[3][SMOOTH_GROUPS_MAX];
    lanes way[SMOOTH_GROUPS_MAX];
};

static void steps_of(const struct window *w, const struct route *r, unsigned piece, struct steps *s)
{
    for (unsigned g = 0; g < r->slots.groups; g++) {
        const lanes_int *c = w->x + (size_t)g * w->capacity + piece;

        for (unsigned k = 0; k < 3; k++) {
            s->step[k][g] = window_weighted(w, g, c[k + 1] - c[k]);
        }
        s->way[g] = s->step[0][g] + s->step[1][g] + s->step[2][g];
    }
}

/*
 * Square of the sine of the largest angle between a piece and the way from its first control point
 * to its last; 1: a right one.
 */
static float turn_square(const struct route *r, const struct steps *s)
{
    const float way = route_dot(r, s->way, s->way);
    float most = 0.0f;

    for (unsigned k = 0; k < 3; k++) {
        const float along = route_dot(r, s->step[k], s->way);
        const float both = route_dot(r, s->step[k], s->step[k]) * way;

        if (along < 0.0f) {
            return 1.0f;
        }
        most = both > 0.0f ? single_max(most, 1.0f - along * along / both) : most;
    }
    return most;
}

/*
 * The most across a piece; it is largest at one of the ends. What lies along the piece takes no
 * place off the line; what lies along the way from its first control point to its last does so
 * where the piece turns from that.
 */
static float second_across(const struct window *w, const struct route *r, unsigned piece)
{
    struct steps s;
    float most = 0.0f;

    steps_of(w, r, piece, &s);
    const float way = route_dot(r, s.way, s.way);
    const float turn = single_sqrt(turn_square(r, &s));

    for (unsigned k = 0; k < 2; k++) {
        lanes second[SMOOTH_GROUPS_MAX];

        for (unsigned g = 0; g < r->slots.groups; g++) {
            second[g] = s.step[k + 1][g] - s.step[k][g];
        }
        const float square = route_dot(r, second, second);
        const float along =
            way > 0.0f ? single_abs(route_dot(r, second, s.way)) / single_sqrt(way) : 0.0f;
        const float across = single_sqrt(single_max(0.0f, square - along * along));

        most = single_max(most, across + turn * along);
    }
    return most;
}

/* How many places of a piece are looked at, and how near they must be. */
struct look {
    unsigned places;
    float within_mm;
    float corner_mm; /* how near chords between them must be to corners and bends */
};

/*
 * Between two places that are h of a piece apart the curve leaves their chord by |x''| h^2/8 at
 * most. So many are looked at that this takes no more than the part that is not verified. The lines
 * through setpoints, a cycle apart, leave corners by more (chord.h).
 */
static struct look look_of(const struct window *w, const struct route *r, unsigned piece)
{
    const float second = second_across(w, r, piece);
    const float tolerance_mm = (float)r->tolerance_mm;
    const float spare_mm = (1.0f - JUDGED) * tolerance_mm;
    struct look look = {.places = 1};

    while (look.places < PLACES_MAX &&
           second > 8.0f * spare_mm * (float)(look.places * look.places)) {
        look.places++;
    }
    const float off = second / (8.0f * (float)(look.places * look.places));

    look.within_mm = single_min(JUDGED * tolerance_mm, tolerance_mm - off);
    look.corner_mm = look.within_mm - takt_chord_leaves(w, r, piece);
    return look;
}

/*
 * The place on the route beside one of the curve. The last samples may be thought to be before
 * those that come to them.
 */
static void find_closest(const struct window *w, const struct route *r, unsigned piece,
                         const float weight[4], struct route_closest *closest)
{
    struct window_spot spot;
    double from;
    double to;
    double ignored;
    double p[AXIS_COUNT];

    closest->element = w->element[piece + 1];
    closest->at_mm = takt_window_at(w, piece, weight);
    takt_window_reach(w, piece + 1, &from, &ignored);
    takt_window_reach(w, piece + 2 < w->count - 1 ? piece + 2 : piece + 1, &ignored, &to);
    takt_window_spot(w, r, piece, weight, &spot);
    takt_window_place(w, r, &spot, p);
    takt_route_closest(r, p, from, maths_max(from, to), closest);
}

/* How far a place of a piece leaves the tolerance; 0 or less: not at all. */
static float beyond_of(const struct window *w, const struct route *r, unsigned piece,
                       unsigned place)
{
    const struct look look = look_of(w, r, piece);
    struct route_closest closest;
    float weight[4];

    TAKT_ASSERT(place <= look.places);
    takt_window_weights((float)place / (float)look.places, weight);
    find_closest(w, r, piece, weight, &closest);
    return closest.distance_mm - look.within_mm;
}

/* From one place looked at to the next one. */
static void set_chord(const struct window *w, const struct route *r, const struct window_spot *from,
                      const struct window_spot *to, struct order_chord *chord)
{
    takt_window_place(w, r, from, chord->from);
    for (unsigned i = 0; i < r->slots.count; i++) {
        chord->way[i] = w->weighted_unit_mm[i] * (float)(to->at[i] - from->at[i]);
    }
}

/* A motion, and how fast it is gone along at its feed. */
struct pace {
    uint32_t element;
    float rate;
};

/*
 * The motion whose feed is the highest, among those that the curve can be on here; no feed where
 * there is none.
 */
static struct pace fastest(const struct route *r, const struct order *order,
                           const struct verifier_need *need)
{
    struct pace most = {.element = order->element, .rate = -1.0f};
    uint32_t e = order->element;

    for (unsigned i = 0; i < order->count; i++) {
        const struct order_span *span = &order->span[i];

        e = takt_route_find(r, span->first_mm, e);
        do {
            const float rate = takt_verifier_programmed(need, r, e);

            most = rate > most.rate ? (struct pace){e, rate} : most;
            e++;
        } while (e < r->count && route_element(r, e)->start_mm < span->last_mm);
    }
    return most;
}

/*
 * The slowest motion from the first to the last that the curve can be on before or after a chord.
 */
static struct pace slowest(const struct route *r, const struct order *before,
                           const struct order *after, const struct verifier_need *need)
{
    const double end_mm = after->span[after->count - 1].last_mm;
    uint32_t e = takt_route_find(r, before->span[0].first_mm, before->element);
    struct pace least = {.element = e, .rate = takt_verifier_programmed(need, r, e)};

    TAKT_ASSERT(before->count > 0 && after->count > 0);
    while (++e < r->count && route_element(r, e)->start_mm < end_mm) {
        const float rate = takt_verifier_programmed(need, r, e);

        least = rate < least.rate ? (struct pace){e, rate} : least;
    }
    return least;
}

/*
 * Is there a way on along a chord which is on motions of this rate or more alone, and passes others
 * in an instant?
 */
static bool keeps_pace(const struct route *r, const struct order *before,
                       const struct verifier_need *need, float rate, struct order_chord chord)
{
    struct order o = *before;

    chord.least_mm_s[0] = need->linear_mm_s > 0.0f ? SAME * rate * need->linear_mm_s : 0.0f;
    chord.least_mm_s[1] = need->rotary_mm_s > 0.0f ? SAME * rate * need->rotary_mm_s : 0.0f;
    takt_order_go(&o, r, &chord);
    return o.count > 0;
}

/*
 * A motion of a feed that the curve may have all along a chord: that of the slower one of its ends,
 * unless it must be on a slower one between them.
 */
static struct pace pace_on(const struct route *r, const struct order *before,
                           const struct order *after, const struct verifier_need *need,
                           const struct order_chord *chord)
{
    const struct pace from = fastest(r, before, need);
    const struct pace to = fastest(r, after, need);
    const struct pace ends = to.rate < from.rate ? to : from;
    const struct pace least = slowest(r, before, after, need);

    return least.rate < ends.rate && !keeps_pace(r, before, need, ends.rate, *chord) ? least : ends;
}

/*
 * The order along a piece, and whose feed is its: at each place of it the curve is on some motion
 * of that feed or more. Its first place from which there is no way on, or 0.
 */
static unsigned follow_piece(struct window *w, const struct route *r, unsigned piece,
                             struct order *order)
{
    const struct look look = look_of(w, r, piece);
    struct order_chord chord = {.within_mm = look.within_mm, .corner_mm = look.corner_mm};
    struct verifier_need need;
    struct window_spot a;
    float weight[4];
    unsigned k = 1;

    takt_verifier_need(w, r, piece, &need);
    struct pace least = fastest(r, order, &need);

    takt_window_weights(0.0f, weight);
    takt_window_spot(w, r, piece, weight, &a);
    for (; k <= look.places && order->count > 0; k++) {
        const struct order before = *order;
        struct window_spot b;

        takt_window_weights((float)k / (float)look.places, weight);
        takt_window_spot(w, r, piece, weight, &b);
        set_chord(w, r, &a, &b, &chord);
        takt_order_go(order, r, &chord);
        a = b;
        if (order->count > 0) {
            const struct pace here = pace_on(r, &before, order, &need, &chord);

            least = here.rate < least.rate ? here : least;
        }
    }
    const bool lost = order->count == 0;

    w->paced[piece] = (unsigned char)((lost ? w->element[piece + 1] : least.element) - r->first);
    return lost ? k - 1 : 0;
}

/* The end of the route must have been come to in order. */
static bool is_end(const struct window *w, unsigned piece)
{
    return w->at_end && piece + 4 == w->count;
}

void takt_verifier_order(struct window *w, const struct route *r, unsigned count,
                         struct order *order)
{
    TAKT_ASSERT(count + 3 <= w->count);
    for (unsigned i = 0; i < count; i++) {
        (void)follow_piece(w, r, i, order);
    }
}

void takt_verifier_pieces(struct window *w, const struct route *r, unsigned count, unsigned keep,
                          const struct order *order, struct verifier_verdict *v)
{
    struct order o = *order;

    TAKT_ASSERT(count + 3 <= w->count);
    v->good = 0;
    v->whole[0] = 0;
    v->beyond_mm = 0.0f;
    v->followed = 0;
    v->order = o;
    while (v->good < count) {
        const unsigned bad = follow_piece(w, r, v->good, &o);
        const bool whole = order_reaches(&o, w->at_mm[v->good + 2]);

        if (bad > 0) {
            v->beyond_mm = beyond_of(w, r, v->good, bad);
            return;
        }
        if (is_end(w, v->good) && !whole) {
            return;
        }
        v->good++;
        v->whole[v->good] = (unsigned char)(whole ? v->good : v->whole[v->good - 1]);
        if (whole && v->good <= keep) {
            v->followed = v->good;
            v->order = o;
        }
    }
}
