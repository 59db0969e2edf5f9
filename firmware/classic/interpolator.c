#include "classic/interpolator.h"

#include "base/assert.h"
#include "base/maths.h"
#include "geometry/place.h"

#include <string.h>

/*
 * Feeds that differ by less, as a part, are the same: rounding of the places they are taken from.
 */
#define SAME_FEED 1e-6

void takt_interpolator_init(struct interpolator *i, const struct interpolator_config *config)
{
    memset(i, 0, sizeof(*i));
    i->config = *config;
}

void takt_interpolator_restart(struct interpolator *i)
{
    i->block = 0;
}

/* range < unit 2^(m-1) */
double takt_interpolator_unit_mm(double increment_mm, double range_mm, unsigned word_bits)
{
    const double most = (double)(INT64_C(1) << (word_bits - 1U));
    double unit_mm = increment_mm;

    TAKT_ASSERT(word_bits >= 2 && word_bits <= 64);
    while (range_mm >= unit_mm * most) {
        unit_mm *= 2.0;
    }
    while (range_mm < 0.5 * unit_mm * most) {
        unit_mm *= 0.5;
    }
    return unit_mm;
}

const struct interpolator_errors *takt_interpolator_get_errors(const struct interpolator *i)
{
    return &i->errors;
}

static bool is_for(enum interpolator_kind kind, const struct curve *c)
{
    switch (kind) {
    case INTERPOLATOR_EXACT:
        return false;
    case INTERPOLATOR_INTEGRATE:
        return c->kind == CURVE_LINE;
    case INTERPOLATOR_ROTATE:
        return c->kind == CURVE_ARC && c->arc.radius_change_mm == 0.0;
    }
    return false;
}

static void begin_line(struct interpolator *i)
{
    takt_integrate_begin(&i->integrate, i->config.unit_mm, &i->curve.start, &i->curve.end,
                         i->curve.length_mm);
}

/* The last bit of a word of angles, all of which are at most dphi = V_max dt / R (3.17). */
static double quantum_rad(const struct interpolator *i)
{
    if (i->config.angle_bits == 0U) {
        return 0.0;
    }
    return i->config.way_max_mm / i->curve.arc.radius_start_mm /
           (double)(1U << i->config.angle_bits);
}

static void begin_circle(struct interpolator *i)
{
    const struct curve *c = &i->curve;

    takt_rotate_begin(&i->rotate, c->start.at[c->arc.first] - c->arc.centre_mm[0],
                      c->start.at[c->arc.second] - c->arc.centre_mm[1], quantum_rad(i));
}

static void begin_block(struct interpolator *i, const struct curve *curve, uint32_t block)
{
    i->block = block;
    i->curve = *curve;
    i->part = 0.0;
    i->way_mm = 0.0;
    i->aimed = false;
    i->along_rad = 0.0;
    i->growth = 0.0;
    i->active = is_for(i->config.kind, curve);
    if (i->active && curve->kind == CURVE_LINE) {
        begin_line(i);
    } else if (i->active) {
        begin_circle(i);
    }
}

static void raise_to(double *largest, double value)
{
    *largest = maths_max(*largest, value);
}

/*
 * V(j+1) = V(j) + a while the feed changes, the exact V when it no longer does. The end rule is for
 * the end of a block that is passed at a constant feed; N is what the planner's feed has left, not
 * rounded to a power of two, since its cycles are the planner's.
 */
static void choose_velocity(struct interpolator *i, double way_mm, double left_mm)
{
    const double change = way_mm - i->way_mm;
    const bool constant = maths_abs(change) <= SAME_FEED * way_mm;

    if (!constant) {
        i->aimed = false;
        takt_integrate_accelerate(&i->integrate, change);
    } else if (i->aimed) {
        return;
    } else if (left_mm <= way_mm * (double)(1U << i->config.end_shift)) {
        takt_integrate_aim(&i->integrate, left_mm / way_mm);
        i->aimed = true;
    } else {
        takt_integrate_set_velocity(&i->integrate, way_mm);
    }
}

static double moving_axes(const struct curve *c)
{
    double count = 0.0;

    for (int n = 0; n < AXIS_COUNT; n++) {
        count += c->start.at[n] != c->end.at[n] ? 1.0 : 0.0;
    }
    return count;
}

/* Every axis loses loss_ulp units at most, and its end is the nearest unit. */
static double integrate_bound(const struct interpolator *i)
{
    return maths_sqrt(moving_axes(&i->curve)) * (i->integrate.loss_ulp + 1.0) *
           i->integrate.unit_mm;
}

static void integrate_to(struct interpolator *i, double part, struct point *cmd)
{
    const struct point exact = *cmd;
    const double way = (part - i->part) * i->curve.length_mm;
    struct point done;

    choose_velocity(i, way, (1.0 - i->part) * i->curve.length_mm);
    takt_integrate_advance(&i->integrate);
    takt_integrate_get_way(&i->integrate, &done);
    i->way_mm = way;
    for (int n = 0; n < AXIS_COUNT; n++) {
        cmd->at[n] = i->curve.start.at[n] + done.at[n];
    }
    raise_to(&i->errors.along_mm, point_distance(cmd, &exact, AXIS_COUNT));
    raise_to(&i->errors.along_bound_mm, integrate_bound(i));
    raise_to(&i->errors.loss_ulp, i->integrate.loss_ulp);
}

/*
 * Sums of R dphi^3 / 6 along, dphi^4 / 8 across: bounds_rotation_... of accuracy/bounds.h for
 * angles that change. Angles in words are late or early by half of the last bit besides.
 */
static void add_rotation_bounds(struct interpolator *i, double angle_rad)
{
    const double radius = i->curve.arc.radius_start_mm;
    const double square = angle_rad * angle_rad;

    i->along_rad += square * maths_abs(angle_rad) / 6.0;
    i->growth += square * square / 8.0;
    raise_to(&i->errors.along_bound_mm, radius * (i->along_rad + 0.5 * i->rotate.quantum_rad));
    raise_to(&i->errors.contour_bound_mm, radius * (takt_maths_exp(i->growth) - 1.0));
}

static void rotate_to(struct interpolator *i, double part, struct point *cmd)
{
    const struct curve_arc *arc = &i->curve.arc;
    const double angle = takt_rotate_step(&i->rotate, (part - i->part) * arc->sweep_rad);
    const double a = i->rotate.a;
    const double b = i->rotate.b;

    const double x = cmd->at[arc->first] - arc->centre_mm[0];
    const double y = cmd->at[arc->second] - arc->centre_mm[1];

    add_rotation_bounds(i, angle);
    raise_to(&i->errors.angle_rad, maths_abs(angle));
    raise_to(&i->errors.contour_mm, maths_abs(maths_sqrt(a * a + b * b) - arc->radius_start_mm));
    raise_to(&i->errors.along_mm,
             arc->radius_start_mm * maths_abs(takt_maths_atan2(x * b - y * a, x * a + y * b)));
    cmd->at[arc->first] = arc->centre_mm[0] + a;
    cmd->at[arc->second] = arc->centre_mm[1] + b;
}

/*
 * The step of this cycle; a landed end is set to its exact value, and what that takes is measured.
 */
static void interpolate(struct interpolator *i, bool landed, struct point *cmd)
{
    const struct point exact = *cmd;
    const double part = landed ? 1.0 : takt_curve_place(&i->curve, cmd, i->part);

    if (i->curve.kind == CURVE_LINE) {
        integrate_to(i, part, cmd);
    } else {
        rotate_to(i, part, cmd);
    }
    i->part = part;
    if (landed) {
        raise_to(&i->errors.landing_mm, point_distance(cmd, &exact, AXIS_COUNT));
        *cmd = exact;
        i->active = false;
    }
}

void takt_interpolator_cycle(struct interpolator *i, const struct curve *curve, uint32_t block,
                             bool landed, struct point *cmd)
{
    if (interpolator_is_exact(i)) {
        return;
    }
    if (block != i->block) {
        begin_block(i, curve, block);
    }
    if (i->active) {
        interpolate(i, landed, cmd);
    }
}
