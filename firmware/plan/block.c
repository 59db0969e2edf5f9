/*
 * Limits of one block along its path.
 *
 * With v, a, j the feed, acceleration and jerk along the path, an axis moves by
 *     x'   = x_s v
 *     x''  = x_s a + x_ss v^2
 *     x''' = x_s j + 3 x_ss v a + x_sss v^3
 * On a line only x_s is not zero. On an arc x_ss is normal to x_s and x_sss points back along it,
 * so in its plane
 *     |x''|^2  = (first a)^2 + (second v^2)^2
 *     |x'''|^2 = (first j + third v^3)^2 + (3 second v a)^2       (worst sign of j)
 * The parts given to each term: curvature ARC_ACCELERATION of the acceleration and ARC_JERK of the
 * jerk at cruise; RAMP_NORMAL and RAMP_ALONG bound the two components of jerk in a ramp
 * (0.6^2 + 0.8^2 = 1).
 */
#include "plan/block.h"

#include "base/assert.h"
#include "base/maths.h"
#include "geometry/involute.h"
#include "plan/path_unit.h"
#include "plan/scale.h"

#include <string.h>

/*
 * An axis outside the plane of an arc of two radii accelerates a little at constant feed: at most
 * this part.
 */
#define SPIRAL_PART 0.1

/*
 * A block lasts at least cycle / CYCLE_BLOCKS_MAX, so that a cycle passes a bounded number of
 * junctions.
 */
#define CYCLE_BLOCKS_MAX 8.0

struct bound {
    double feed_mm_s;
    enum governor governor;
};

static void bound_lower(struct bound *c, double feed_mm_s, enum governor governor)
{
    if (feed_mm_s < c->feed_mm_s) {
        c->feed_mm_s = feed_mm_s;
        c->governor = governor;
    }
}

/* On an arc: second v^2 <= ARC_ACCELERATION A, third v^3 <= ARC_JERK J. */
static struct bound block_ceiling(const struct block *b, double jerk_budget, double program_mm_s)
{
    const struct block_shape *shape = &b->shape;
    struct bound c = {program_mm_s, GOVERNOR_PROGRAM};

    bound_lower(&c, b->feed_cap_mm_s, b->cap);
    if (shape->first > 0.0) {
        const double a = shape->plane_a_mm_s2 * (1.0 - ACCELERATION_PER_JERK_BUDGET * jerk_budget);
        const double j = shape->plane_j_mm_s3 * (1.0 - jerk_budget);

        bound_lower(&c, maths_sqrt(ARC_ACCELERATION * a / shape->second), GOVERNOR_ACCELERATION);
        bound_lower(&c, takt_maths_cbrt(ARC_JERK * j / shape->third), GOVERNOR_JERK);
    }
    return c;
}

/* What an arc at feed v leaves for a ramp: the formulas at the top solved for a and j. */
static void limit_arc_ramp(struct block *b, double jerk_budget, double v)
{
    const struct block_shape *shape = &b->shape;
    const double a_max = shape->plane_a_mm_s2 * (1.0 - ACCELERATION_PER_JERK_BUDGET * jerk_budget);
    const double j_max = shape->plane_j_mm_s3 * (1.0 - jerk_budget);
    const double normal = shape->second * v * v;
    const double along = maths_sqrt(a_max * a_max - normal * normal) / shape->first;
    const double turning = RAMP_NORMAL * j_max / (3.0 * shape->second * v);
    const double j = (RAMP_ALONG * j_max - shape->third * v * v * v) / shape->first;

    TAKT_ASSERT(shape->second > 0.0 && v > 0.0);
    b->a_mm_s2 = maths_min(b->a_mm_s2, maths_min(along, turning));
    b->j_mm_s3 = maths_min(b->j_mm_s3, j);
}

/*
 * Limits are found for the highest override, so that they hold while the feed is on its way to a
 * lower one.
 */
void takt_block_set_jerk_budget(struct block *b, double jerk_budget)
{
    TAKT_ASSERT(jerk_budget >= 0.0 && jerk_budget <= BLOCK_JERK_BUDGET_MAX);
    b->jerk_budget = jerk_budget;
    b->feed_max_mm_s =
        block_ceiling(b, jerk_budget, BLOCK_OVERRIDE_MAX * b->feed_program_mm_s).feed_mm_s;
    b->a_mm_s2 = b->shape.line_a_mm_s2 * (1.0 - ACCELERATION_PER_JERK_BUDGET * jerk_budget);
    b->j_mm_s3 = b->shape.line_j_mm_s3 * (1.0 - jerk_budget);
    if (b->shape.first > 0.0) {
        limit_arc_ramp(b, jerk_budget, b->feed_max_mm_s);
    }
    TAKT_ASSERT(b->feed_max_mm_s >= 0.0 && b->a_mm_s2 >= 0.0 && b->j_mm_s3 >= 0.0);
}

void takt_block_cap_feed(struct block *b, double feed_mm_s, enum governor governor)
{
    TAKT_ASSERT(feed_mm_s > 0.0);
    if (feed_mm_s < b->feed_cap_mm_s) {
        b->feed_cap_mm_s = feed_mm_s;
        b->cap = governor;
        takt_block_set_jerk_budget(b, b->jerk_budget);
    }
}

double takt_block_top_feed(const struct block *b)
{
    return block_ceiling(b, 0.0, BLOCK_OVERRIDE_MAX * b->feed_program_mm_s).feed_mm_s;
}

double takt_block_limit(const struct block *b, enum governor *governor)
{
    const struct bound c = block_ceiling(b, b->jerk_budget, MATHS_INFINITY);

    *governor = c.governor;
    return c.feed_mm_s;
}

/*
 * Limits of one axis that moves straight along the path, or, beside an arc of two radii, nearly so:
 * with u = second v^2 / A and w = (third v^3 + 3 second v a) / J it keeps u <= SPIRAL_PART and both
 * terms of w <= SPIRAL_PART / 2 at the highest feed v, and leaves 1 - 2u and 1 - 2w to a and j. The
 * factor 2 = 1 / (1 - BLOCK_JERK_BUDGET_MAX): what junctions take is taken from a and j alone.
 */
static void limit_line_axis(struct block_shape *shape, struct bound *c,
                            const struct curve_bounds *bounds, const struct plan_limits *limits,
                            int i)
{
    const double second = bounds->second[i];
    double a = limits->acceleration_mm_s2[i];
    double j = limits->jerk_mm_s3[i];

    TAKT_ASSERT(bounds->first[i] > 0.0 || !(second > 0.0));
    if (second > 0.0) {
        const double part_j = 0.5 * SPIRAL_PART * j;

        bound_lower(c, maths_sqrt(SPIRAL_PART * a / second), GOVERNOR_ACCELERATION);
        bound_lower(c, takt_maths_cbrt(part_j / bounds->third[i]), GOVERNOR_JERK);
        const double v = c->feed_mm_s;
        const double path_a =
            maths_min((a - 2.0 * second * v * v) / bounds->first[i], part_j / (3.0 * second * v));

        a = path_a * bounds->first[i];
        j -= 2.0 * (bounds->third[i] * v * v * v + 3.0 * second * v * path_a);
    }
    if (bounds->first[i] > 0.0) {
        shape->line_a_mm_s2 = maths_min(shape->line_a_mm_s2, a / bounds->first[i]);
        shape->line_j_mm_s3 = maths_min(shape->line_j_mm_s3, j / bounds->first[i]);
    }
}

/*
 * Chord error: v = (2/cycle) sqrt(2 R d - d^2) (cycle-frequency page, (3) turned round); R <= d
 * needs none.
 */
static double chord_feed(double radius_mm, double chord_mm, double cycle_s)
{
    TAKT_ASSERT(radius_mm >= 0.0 && cycle_s > 0.0);
    if (radius_mm <= chord_mm) {
        return MATHS_INFINITY;
    }
    return 2.0 / cycle_s * maths_sqrt(chord_mm * (2.0 * radius_mm - chord_mm));
}

/*
 * On an involute the chord from its base circle is the worst: whichever of both rules allows more
 * holds.
 */
static double chord_ceiling(const struct curve *curve, const struct curve_bounds *bounds,
                            const struct plan_limits *limits)
{
    const double chord_mm = limits->chord_error_max_mm;
    const double round = chord_feed(bounds->radius_min_mm, chord_mm, limits->cycle_s);

    if (curve->kind != CURVE_INVOLUTE) {
        return round;
    }
    const double cusped = takt_involute_step_max(curve, chord_mm) / limits->cycle_s;

    return bounds->radius_min_mm <= chord_mm ? cusped : maths_max(cusped, round);
}

/*
 * On an arc of two radii x_ss and x_sss are not quite normal to the path and along it. What the
 * formulas at the top miss is at most along (second v^2) in acceleration, and along (3 second v
 * a) + across (third v^3) in jerk.
 */
static void limit_curved_plane(struct block_shape *shape, enum axis first, enum axis second,
                               const struct curve_bounds *bounds, const struct plan_limits *limits)
{
    const double along = bounds->second_along / bounds->second[first];
    const double across = bounds->third_across / bounds->third[first];

    TAKT_ASSERT(bounds->second[first] > 0.0 && bounds->third[first] > 0.0);
    shape->first = bounds->first[first];
    shape->second = bounds->second[first];
    shape->third = bounds->third[first];
    shape->plane_a_mm_s2 =
        maths_min(limits->acceleration_mm_s2[first], limits->acceleration_mm_s2[second]) /
        (1.0 + ARC_ACCELERATION * along);
    shape->plane_j_mm_s3 = maths_min(limits->jerk_mm_s3[first], limits->jerk_mm_s3[second]) /
                           (1.0 + RAMP_NORMAL * along + ARC_JERK * across);
}

/*
 * A piece that begins or ends on an involute's base circle is gone from or to rest: its curvature
 * there is bounded by what the ramp does (geometry/involute.h), so the plane's axes count like one
 * that moves straight, with lower limits.
 */
static void limit_cusp_plane(struct block_shape *shape, enum axis first, enum axis second,
                             const struct curve_bounds *bounds, const struct plan_limits *limits)
{
    const double a =
        maths_min(limits->acceleration_mm_s2[first], limits->acceleration_mm_s2[second]);
    const double j = maths_min(limits->jerk_mm_s3[first], limits->jerk_mm_s3[second]);
    const double ratio = bounds->first[first];

    shape->line_a_mm_s2 = maths_min(
        shape->line_a_mm_s2, a / (ratio * takt_involute_cusp_acceleration(bounds->cusp_rad)));
    shape->line_j_mm_s3 =
        maths_min(shape->line_j_mm_s3, j / (ratio * takt_involute_cusp_jerk(bounds->cusp_rad)));
}

/* Derivatives by the path, of which a mm is so much of the curve; the radius stays what it is. */
static void scale_bounds(struct curve_bounds *b, double scale)
{
    const double square = scale * scale;

    TAKT_ASSERT(scale > 0.0);
    for (int i = 0; i < AXIS_COUNT; i++) {
        b->first[i] *= scale;
        b->second[i] *= square;
        b->third[i] *= square * scale;
    }
    b->second_along *= square;
    b->third_across *= square * scale;
}

/* Limits of the axes, and for curved curves the chord error. */
static void limit_axes(struct block_shape *shape, struct bound *c, const struct curve *curve,
                       double scale, const struct plan_limits *limits)
{
    struct curve_bounds bounds;
    enum axis first = AXIS_COUNT;
    enum axis second = AXIS_COUNT;
    const bool curved = takt_curve_plane(curve, &first, &second);

    takt_curve_bound(curve, &bounds);
    scale_bounds(&bounds, scale);
    TAKT_ASSERT(!curved || (first != second && first < AXIS_COUNT && second < AXIS_COUNT));
    for (int i = 0; i < AXIS_COUNT; i++) {
        if (bounds.first[i] > 0.0) {
            bound_lower(c, limits->velocity_mm_s[i] / bounds.first[i], GOVERNOR_VELOCITY);
        }
    }
    for (int i = 0; i < AXIS_COUNT; i++) {
        if (i != (int)first && i != (int)second) {
            limit_line_axis(shape, c, &bounds, limits, i);
        }
    }
    if (curved && bounds.cusp_rad > 0.0) {
        limit_cusp_plane(shape, first, second, &bounds, limits);
    } else if (curved) {
        limit_curved_plane(shape, first, second, &bounds, limits);
    }
    if (curved) {
        bound_lower(c, chord_ceiling(curve, &bounds, limits) / scale, GOVERNOR_CHORD);
    }
}

void takt_block_set_motion(struct block *b, const struct move *move, const struct curve *curve,
                           const struct plan_limits *limits)
{
    const struct scale machine = takt_scale_of_machine(limits);
    struct bound c = {MATHS_INFINITY, GOVERNOR_VELOCITY};

    TAKT_ASSERT(curve->length_mm > 0.0);
    memset(b, 0, sizeof(*b));
    b->move = *move;
    b->curve = *curve;
    b->scale = takt_scale_of_curve(curve, &machine);
    b->feed_program_mm_s = move->kind == MOVE_RAPID ? MATHS_INFINITY : move->feed_mm_s / b->scale;
    b->length_mm = curve->length_mm / b->scale;
    b->length = path_units(b->length_mm);
    b->end = JUNCTION_STOP;
    b->shape.line_a_mm_s2 = MATHS_INFINITY;
    b->shape.line_j_mm_s3 = MATHS_INFINITY;
    limit_axes(&b->shape, &c, curve, b->scale, limits);
    bound_lower(&c, CYCLE_BLOCKS_MAX * b->length_mm / limits->cycle_s, GOVERNOR_SHORT);
    b->feed_cap_mm_s = c.feed_mm_s;
    b->cap = c.governor;
    TAKT_ASSERT(b->feed_cap_mm_s > 0.0);
    takt_block_set_jerk_budget(b, BLOCK_JERK_BUDGET_MAX);
}

/* Its limits hold for every rate of nominal time up to the highest one. */
void takt_block_set_smooth(struct block *b, const struct smooth_piece *piece, double unit_mm)
{
    const struct smooth_rate *rate = &piece->rate;

    TAKT_ASSERT(piece->interval_s > 0.0 && unit_mm > 0.0);
    memset(b, 0, sizeof(*b));
    b->move = *piece->move;
    b->number = piece->number;
    takt_curve_set_spline(&b->curve, piece->control, unit_mm * piece->interval_s);
    b->curve.rotary = piece->rotary;
    b->scale = 1.0;
    b->length_mm = b->curve.length_mm;
    b->length = path_units(b->length_mm);
    b->feed_program_mm_s = rate->programmed * unit_mm;
    b->feed_cap_mm_s = rate->most * unit_mm;
    b->cap = GOVERNOR_SMOOTH;
    b->shape.line_a_mm_s2 = piece->change.by * unit_mm;
    b->shape.line_j_mm_s3 = piece->change.rounded * unit_mm;
    TAKT_ASSERT(b->feed_cap_mm_s > 0.0 && b->length > 0);
    b->end = JUNCTION_STOP;
    takt_block_set_jerk_budget(b, 0.0);
}

void takt_block_join_smooth(struct block *b, const struct block *next)
{
    b->end = JUNCTION_PASSED;
    b->feed_junction_mm_s = MATHS_INFINITY;
    b->continues = b->number == next->number;
}

bool takt_block_turns(const struct block *b)
{
    bool turns = false;

    for (int i = AXIS_LINEAR_COUNT; i < AXIS_COUNT; i++) {
        turns = turns || b->curve.slope.at[i] != 0.0;
    }
    return turns;
}

void takt_block_set_wait(struct block *b, const struct move *move)
{
    TAKT_ASSERT(!move_is_motion(move));
    memset(b, 0, sizeof(*b));
    b->move = *move;
    b->end = JUNCTION_STOP;
}
