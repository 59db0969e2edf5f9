/* What the rows of a window count beside each other. */
#include "smooth/relax_parts.h"

#include "base/assert.h"
#include "smooth/single.h"

#include <string.h>

/* Rows that count more than this, relative to the tolerance, would leave too few digits. */
#define SCALE_MAX 300.0f

/* Rows of second differences count so much more: along straights they alone find ramps. */
#define SECOND_COUNTS 2.0f

/* The need of the axis of least acceleration counts for all, up to so many times the most's. */
#define SECOND_SPAN 4.0f

/* The least and the most that a row counts, over the slots of a group. */
struct relax_span {
    float least, most;
};

static void widen(struct relax_span *span, float per_near)
{
    span->least = single_min(span->least, per_near);
    span->most = single_max(span->most, per_near);
}

/* Lanes whose axes move in the window; all of them where none does. */
static lanes_int moving(const struct window *w, unsigned group)
{
    const lanes_int *c = w->x + (size_t)group * w->capacity;
    lanes_int moves = {0};

    for (unsigned i = 1; i < w->count; i++) {
        moves |= c[i] ^ c[0];
    }
    return lanes_any(moves) ? moves : ~moves;
}

/*
 * What rows of second and third differences count is the same for all axes of a group, so that one
 * matrix serves them all: by those that move in the window. On machines that were tried, with axes
 * up to ten times as quick as others, these came nearest to a matrix for each axis.
 */
static void set_rows(struct relax_scale *s, const struct window *w, const struct route *r,
                     unsigned group, float tolerance_mm)
{
    struct relax_span second = {SCALE_MAX, 0.0f};
    struct relax_span third = {SCALE_MAX, 0.0f};
    const unsigned first = group * SMOOTH_LANES;
    const lanes_int counts = moving(w, group);
    const float d = (float)w->interval_s;

    for (unsigned i = first; i < first + SMOOTH_LANES && i < r->slots.count; i++) {
        const float per_near = tolerance_mm / r->slots.weight[i];

        s->second_most[group][i - first] = r->slots.acceleration_mm_s2[i] * d * d / per_near;
        s->third_most[group][i - first] = r->slots.jerk_mm_s3[i] * d * d * d / per_near;
        if (counts[i - first] != 0) {
            widen(&second, 1.0f / s->second_most[group][i - first]);
            widen(&third, 1.0f / s->third_most[group][i - first]);
        }
    }
    s->second_per_near[group] =
        single_min(SECOND_COUNTS * single_min(second.most, SECOND_SPAN * second.least), SCALE_MAX);
    s->third_per_near[group] = single_min(single_sqrt(third.most * third.least), SCALE_MAX);
    s->second_most[group] *= s->second_per_near[group];
    s->third_most[group] *= s->third_per_near[group];
}

void takt_relax_set_scale(struct relax_scale *s, const struct window *w, const struct route *r,
                          float tolerance_mm)
{
    const float d = (float)w->interval_s;

    TAKT_ASSERT(tolerance_mm > 0.0f && d > 0.0f);
    memset(s, 0, sizeof(*s));
    s->change = r->slots.change_per_s * d;
    s->rounded = r->slots.rounded_per_s2 * d * d;
    for (unsigned i = 0; i < r->slots.count; i++) {
        s->near_per_unit[i / SMOOTH_LANES][i % SMOOTH_LANES] =
            w->weighted_unit_mm[i] / tolerance_mm;
        s->unit_per_near[i / SMOOTH_LANES][i % SMOOTH_LANES] =
            tolerance_mm / w->weighted_unit_mm[i];
    }
    for (unsigned g = 0; g < r->slots.groups; g++) {
        set_rows(s, w, r, g, tolerance_mm);
    }
}
