#include "classic/integrate_line.h"

#include "base/maths.h"

/* dS = (V^2 - V_end^2) / (2 a) */
static double takt_braking_way(const struct integrate_line_config *c, double way_mm)
{
    return 0.5 * (way_mm - c->end_mm) * (way_mm + c->end_mm) / c->acceleration_mm;
}

/* N */
static double end_cycles(const struct integrate_line *l)
{
    return (double)(1U << l->config.end_shift);
}

static void measure_left(struct integrate_line *l)
{
    const unsigned n = l->leading;

    l->left_mm =
        (double)(l->axes.end[n] - l->axes.position[n]) * l->axes.unit_mm / l->axes.ratio[n];
}

void takt_integrate_line_begin(struct integrate_line *l, const struct integrate_line_config *config,
                               const struct point *start, const struct point *end)
{
    *l = (struct integrate_line){.config = *config};
    takt_integrate_begin(&l->axes, config->unit_mm, start, end, config->length_mm);
    for (unsigned n = 0; n < AXIS_COUNT; n++) {
        if (maths_abs(l->axes.ratio[n]) > maths_abs(l->axes.ratio[l->leading])) {
            l->leading = n;
        }
    }
    l->way_mm = config->start_mm;
    takt_integrate_set_velocity(&l->axes, l->way_mm);
    measure_left(l);
}

/* With one more cycle of that way too little would be left for braking. */
static bool must_brake(const struct integrate_line *l, double way_mm)
{
    const struct integrate_line_config *c = &l->config;
    const double ahead = takt_braking_way(c, way_mm) + end_cycles(l) * c->end_mm;

    return l->left_mm - way_mm <= ahead;
}

static void accelerate(struct integrate_line *l)
{
    const double next = l->way_mm + l->config.acceleration_mm;

    if (must_brake(l, maths_min(next, l->config.feed_mm))) {
        l->phase = INTEGRATE_BRAKING;
    } else if (next >= l->config.feed_mm) {
        l->way_mm = l->config.feed_mm;
        takt_integrate_set_velocity(&l->axes, l->way_mm);
        l->phase = INTEGRATE_CONSTANT;
    } else {
        l->way_mm = next;
        takt_integrate_accelerate(&l->axes, l->config.acceleration_mm);
    }
}

/* Down to V_end, or for a stop to the feed of one step of braking, which creeps to the end. */
static void brake(struct integrate_line *l)
{
    const double lowest = l->config.end_mm > 0.0 ? l->config.end_mm : l->config.acceleration_mm;

    if (l->way_mm - l->config.acceleration_mm > lowest) {
        l->way_mm -= l->config.acceleration_mm;
        takt_integrate_accelerate(&l->axes, -l->config.acceleration_mm);
        return;
    }
    l->way_mm = maths_min(l->way_mm, lowest);
    takt_integrate_set_velocity(&l->axes, l->way_mm);
    l->phase = INTEGRATE_ENDING;
}

/* The end rule: way left <= N V_end, and V has come down to V_end. */
static void look_for_end(struct integrate_line *l)
{
    const double reach = l->config.end_mm * end_cycles(l);

    if (l->phase == INTEGRATE_ENDING && l->config.end_mm > 0.0 && l->left_mm <= reach) {
        takt_integrate_aim(&l->axes, end_cycles(l));
        l->phase = INTEGRATE_AIMED;
    }
}

/*
 * Words too short for the velocity do not move any more: the exact end is all that is left to do.
 */
static bool stands(const struct integrate_line *l)
{
    return l->phase != INTEGRATE_ACCELERATING && l->axes.velocity[l->leading] == 0;
}

static bool ends_now(const struct integrate_line *l)
{
    if (l->phase == INTEGRATE_AIMED) {
        return l->aimed_cycles + 1U == 1U << l->config.end_shift;
    }
    return l->left_mm <= l->way_mm || stands(l);
}

static void choose_velocity(struct integrate_line *l)
{
    if (l->phase == INTEGRATE_ACCELERATING) {
        accelerate(l);
    }
    if (l->phase == INTEGRATE_CONSTANT && must_brake(l, l->way_mm)) {
        l->phase = INTEGRATE_BRAKING;
    }
    if (l->phase == INTEGRATE_BRAKING) {
        brake(l);
    }
    look_for_end(l);
}

bool takt_integrate_line_cycle(struct integrate_line *l)
{
    if (l->phase == INTEGRATE_LANDED) {
        return false;
    }
    choose_velocity(l);
    if (ends_now(l)) {
        takt_integrate_land(&l->axes);
        l->phase = INTEGRATE_LANDED;
        l->left_mm = 0.0;
        return true;
    }
    l->aimed_cycles += l->phase == INTEGRATE_AIMED ? 1U : 0U;
    takt_integrate_advance(&l->axes);
    measure_left(l);
    return true;
}
