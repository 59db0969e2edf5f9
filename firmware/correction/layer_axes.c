/*
 * Axis tables: pitch, straightness and squareness over one axis each, and backlash by the direction
 * of approach.
 *
 * The direction of an axis is that of its last motion. It counts as reversed when the axis has come
 * back by REVERSAL_MM from the furthest it went, so that rounding turns nothing; the tables of both
 * directions then fade into each other.
 *
 * Errors of units, which act along the machine's chain, are tables over one axis too, and taken
 * back with them.
 */
#include "base/assert.h"
#include "correction/layer.h"

#define REVERSAL_MM 1e-6

static bool axes_begin(const struct correction *c, struct layer_notes *notes)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        notes->fade[i].value = 1.0;
        notes->coefficient[i] = 1.0F;
        notes->number[i] = 1.0;
        notes->number[AXIS_COUNT + i] = c->at->at[i];
    }
    return c->tables != NULL && (c->tables->axes.count > 0 || c->tables->geometry != NULL);
}

/* number[axis] is the direction, number[AXIS_COUNT + axis] the furthest position in it. */
static void follow_direction(const struct correction *c, struct layer_notes *notes, unsigned axis)
{
    double *direction = &notes->number[axis];
    double *furthest = &notes->number[AXIS_COUNT + axis];
    const double ahead = *direction * (c->at->at[axis] - *furthest);

    TAKT_ASSERT(axis < AXIS_COUNT);
    if (ahead > 0.0) {
        *furthest = c->at->at[axis];
    } else if (ahead < -REVERSAL_MM) {
        *direction = -*direction;
        *furthest = c->at->at[axis];
    }
}

static void axes_follow(struct correction *c, struct layer_notes *notes)
{
    for (unsigned i = 0; i < c->axes_end; i++) {
        if ((c->tables->axes.inputs & 1U << i) == 0) {
            continue;
        }
        follow_direction(c, notes, i);
        if (!fade_is_at(&notes->fade[i], notes->number[i])) {
            (void)fade_cycle(&notes->fade[i], notes->number[i], &c->reversal_pace);
            notes->coefficient[i] = (float)notes->fade[i].value;
        }
    }
}

static void axes_add(struct correction *c, struct layer_notes *notes, double weight,
                     struct correction_sum *sum)
{
    const struct geometry *g = c->tables->geometry;

    sum->outside |=
        takt_axis_tables_sum(&c->tables->axes, c->at, notes->coefficient, (float)weight, sum->fine);
    if (g != NULL) {
        sum->outside |= g->take_back(g, c->at, weight, c->axes_end, sum->fine);
    }
}

static void axes_need(const struct correction *c, const struct layer_notes *notes,
                      const struct motion_bound *most, struct need *need)
{
    /* From -1 to 1, twice the step the fade's bounds are for. */
    const struct approach_bound approach = {
        .velocity_per_s = 2.0 * takt_fade_velocity_per_s(&c->reversal_pace),
        .acceleration_per_s2 = 2.0 * takt_fade_acceleration_per_s2(&c->reversal_pace),
        .jerk_per_s3 = 2.0 * takt_fade_jerk_per_s3(&c->reversal_pace),
    };

    (void)notes;
    takt_axis_tables_need(&c->tables->axes, &approach, most, need);
    if (c->tables->geometry != NULL) {
        c->tables->geometry->need(c->tables->geometry, most, need);
    }
}

const struct correction_layer takt_layer_axes = {
    .name = "axes",
    .begin = axes_begin,
    .follow = axes_follow,
    .add = axes_add,
    .need = axes_need,
};
