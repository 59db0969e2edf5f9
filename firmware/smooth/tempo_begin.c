/* What the search for the best tempo begins with: the window's differences, and what limits b. */
#include "smooth/tempo_begin.h"

#include "base/assert.h"
#include "smooth/chord.h"
#include "smooth/single.h"
#include "smooth/verifier.h"

/*
 * New samples are put on the curve from outside: that takes some of the jerk, and as much
 * acceleration of an interval.
 */
#define THIRD_PART      0.95f
#define THIRD_OF_SECOND 0.5f

/* Corners that turn less are no matter: relax_corners.c. */
#define CORNER_MIN 0.005f

/* What lines through setpoints, a cycle apart, may leave the curve by there, of the tolerance. */
#define CHORD_PART 0.5f

/*
 * A change of velocity dv in a time T passes its corner at dv T/8, and chords of tau leave it by dv
 * tau^2/8T. Of all T for which both come to P, dv is the largest where each comes to a half: T =
 * tau. They leave it by b times as much at b: beside the corner, as many pieces as a cycle takes.
 */
static void limit_corner(struct tempo *p, const struct window *w, const struct route *r,
                         unsigned piece)
{
    const unsigned reach = r->chord.pieces;
    const float leaves_mm = takt_chord_leaves(w, r, piece);
    const float room_mm = CHORD_PART * (float)r->tolerance_mm;

    for (unsigned i = piece > reach ? piece - reach : 0;
         leaves_mm > room_mm && i < piece + 3 + reach && i < p->pieces + 2; i++) {
        p->most[i] = single_min(p->most[i], room_mm / leaves_mm);
    }
}

static void limit_corners(struct tempo *p, const struct window *w, const struct route *r)
{
    unsigned piece = 0;

    for (uint32_t e = w->element[1] + 1; e < r->count; e++) {
        const double at = route_element(r, e)->start_mm;

        while (piece < p->pieces && w->at_mm[piece + 2] <= at) {
            piece++;
        }
        if (piece == p->pieces) {
            return;
        }
        if (route_turn(r, e) > CORNER_MIN && w->at_mm[piece + 1] <= at) {
            limit_corner(p, w, r, piece);
        }
    }
}

/* b <= (V/x')^2 and (F/|x'|)^2 of every piece that the coefficient belongs to. */
static void set_most(struct tempo *p, const struct window *w, const struct route *r)
{
    for (unsigned i = 0; i < p->pieces + 2; i++) {
        p->most[i] = RATE_SQUARED_MOST;
    }
    for (unsigned i = 0; i < p->pieces; i++) {
        struct verifier_need need;

        takt_verifier_need(w, r, i, &need);
        float feed = single_min(single_sqrt(RATE_SQUARED_MOST),
                                takt_verifier_programmed(&need, r, w->element[i + 1]));

        for (unsigned k = 0; k < r->slots.count; k++) {
            if (feed * need.first[k] > r->slots.velocity_mm_s[k]) {
                feed = r->slots.velocity_mm_s[k] / need.first[k];
            }
        }
        for (unsigned k = 0; k < 3; k++) {
            p->most[i + k] = single_min(p->most[i + k], feed * feed);
        }
    }
    limit_corners(p, w, r);
    for (unsigned i = 0; i < p->pieces + 2; i++) {
        p->most[i] = single_max(p->most[i], 2.0f * RATE_SQUARED_MIN);
    }
}

static void set_scale(struct tempo *p, const struct window *w, const struct route *r)
{
    const float d = (float)w->interval_s;

    p->change = r->slots.change_per_s * d;
    p->rounded = r->slots.rounded_per_s2 * d * d;
    for (unsigned i = 0; i < r->slots.count; i++) {
        const float unit = (float)w->unit_mm[i];
        const float second = r->slots.acceleration_mm_s2[i] * d * d;
        const float third = THIRD_PART * r->slots.jerk_mm_s3[i] * d * d * d;

        p->second_per_unit[i] = unit / second;
        p->third_per_unit[i] = unit / single_min(third, THIRD_OF_SECOND * second);
        p->third_all[i] = third / single_min(third, THIRD_OF_SECOND * second);
    }
}

/* The curve's differences where pieces begin, and where the last one ends. */
static void set_differences(struct tempo *p, const struct window *w, const struct route *r)
{
    p->capacity = w->capacity;
    for (unsigned slot = 0; slot < r->slots.count; slot++) {
        for (unsigned i = 0; i + 2 < w->count; i++) {
            const int32_t x = window_x(w, slot, i + 1);
            const float before = (float)(x - window_x(w, slot, i));
            const float after = (float)(window_x(w, slot, i + 2) - x);

            p->first[slot * w->capacity + i] = 0.5f * (before + after);
            p->second[slot * w->capacity + i] = after - before;
        }
    }
}

void takt_tempo_begin(struct tempo *p, const struct window *w, const struct route *r)
{
    TAKT_ASSERT(p->pieces + 2 <= TEMPO_MAX);
    set_scale(p, w, r);
    set_differences(p, w, r);
    set_most(p, w, r);
}
