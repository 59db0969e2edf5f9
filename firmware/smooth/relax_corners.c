/* The corners of the route in a window, each with the place of the curve that passes it. */
#include "smooth/relax_parts.h"

#include "base/assert.h"
#include "smooth/chord.h"
#include "smooth/single.h"

#include <string.h>

/*
 * Corners that leave the chord of two samples by a small part of the tolerance, turn times spacing,
 * need no condition of their own.
 */
#define CORNER_LEAVES 0.5f

/* A mean direction shorter than this belongs to a reversal. */
#define REVERSAL 0.3f

/* Corners and bends need be no nearer than this part of the tolerance: README.md. */
#define CORNER_LEAST 0.1f

static void set_along(struct relax_corners *c, const struct route *r, uint32_t element)
{
    float before[AXIS_COUNT];
    float after[AXIS_COUNT];
    float square = 0.0f;

    takt_route_corner(r, element, before, after);
    for (unsigned i = 0; i < r->slots.count; i++) {
        before[i] += after[i];
        square += before[i] * before[i];
    }
    const float length = single_sqrt(square);
    const float per_length = length > REVERSAL ? 1.0f / length : 0.0f;

    for (unsigned i = 0; i < r->slots.count; i++) {
        c->along[i / SMOOTH_LANES * c->capacity + c->count][i % SMOOTH_LANES] =
            before[i] * per_length;
    }
}

/*
 * What lines through setpoints leave it by is of all of the tolerance: a curve in a part of that
 * may use the part. A curve that is drawn into a corner bends the more.
 */
float takt_relax_most(const struct window *w, const struct route *r, unsigned piece,
                      float tolerance_mm)
{
    const float all_mm = tolerance_mm / r->part;
    const float most = (all_mm - takt_chord_leaves(w, r, piece)) / tolerance_mm;

    TAKT_ASSERT(tolerance_mm > 0.0f && r->part > 0.0f);
    return single_clamp(most, CORNER_LEAST, 1.0f);
}

static void set_spot(struct relax_corners *c, const struct window *w, const struct route *r,
                     uint32_t element)
{
    struct window_spot spot;

    takt_window_nearest(w, r, route_start(r, element), &spot);
    for (unsigned i = 0; i < r->slots.count; i++) {
        c->spot[i / SMOOTH_LANES * c->capacity + c->count][i % SMOOTH_LANES] = spot.at[i];
    }
}

/*
 * Where the curve passes the start of an element: the piece and the fraction by the places of its
 * samples.
 */
static void add_corner(struct relax_corners *c, const struct window *w, const struct route *r,
                       uint32_t element, float tolerance_mm, unsigned *sample)
{
    const double at = route_element(r, element)->start_mm;
    unsigned i = *sample;

    TAKT_ASSERT(c->count < c->capacity);
    while (i + 2 < w->count && w->at_mm[i + 1] <= at) {
        i++;
    }
    *sample = i;
    if (i + 2 >= w->count || w->at_mm[i] > at) {
        return;
    }
    const float spacing = (float)(w->at_mm[i + 1] - w->at_mm[i]);

    if (route_turn(r, element) * spacing < CORNER_LEAVES * (float)r->tolerance_mm) {
        return;
    }
    c->piece[c->count] = (unsigned char)(i - 1);
    c->fraction[c->count] = (float)(at - w->at_mm[i]) / spacing;
    c->most[c->count] = takt_relax_most(w, r, i - 1, tolerance_mm);
    set_along(c, r, element);
    set_spot(c, w, r, element);
    c->count++;
}

void takt_relax_find_corners(struct relax_corners *c, const struct window *w, const struct route *r,
                             float tolerance_mm)
{
    unsigned sample = 1;

    TAKT_ASSERT(r->slots.groups > 0);
    memset(c, 0, sizeof(*c));
    c->capacity = RELAX_CORNERS_MAX / r->slots.groups;
    for (uint32_t e = w->element[1] + 1; e < r->count && c->count < c->capacity; e++) {
        if (route_element(r, e)->start_mm > w->at_mm[w->count - 2]) {
            return;
        }
        add_corner(c, w, r, e, tolerance_mm, &sample);
    }
}
