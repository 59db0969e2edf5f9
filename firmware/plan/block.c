/*
 * Limits of one block along its path.
 *
 * With v, a, j the feed, acceleration and jerk along the path, an axis moves by
 *     x'   = x_s v
 *     x''  = x_s a + x_ss v^2
 *     x''' = x_s j + 3 x_ss v a + x_sss v^3
 * On a line only x_s is not zero. On an arc x_ss is normal to x_s and x_sss points back along it, so in its plane
 *     |x''|^2  = (first a)^2 + (second v^2)^2
 *     |x'''|^2 = (first j + third v^3)^2 + (3 second v a)^2       (worst sign of j)
 * The parts given to each term: curvature ARC_ACCELERATION of the acceleration and ARC_JERK of the jerk at cruise;
 * RAMP_NORMAL and RAMP_ALONG bound the two components of jerk in a ramp (0.6^2 + 0.8^2 = 1).
 */
#include "plan/block.h"

#include "base/maths.h"

#include <string.h>

#define ARC_ACCELERATION 0.9
#define ARC_JERK         0.5
#define RAMP_NORMAL      0.6
#define RAMP_ALONG       0.8

/* A joint that uses a share of the jerk uses at most this part of it of the acceleration (joint.c). */
#define ACCELERATION_PER_SHARE 0.2

/* An axis outside the plane of a spiral arc accelerates a little at constant feed; it keeps this part for that. */
#define SPIRAL_PART 0.1

/* A block lasts at least cycle / CYCLE_BLOCKS_MAX, so that a cycle passes a bounded number of joints. */
#define CYCLE_BLOCKS_MAX 8.0

/* Ramp to a third of the feed against ramp to a stop, rounded up: see block_start_feed. */
#define RAMP_DETOUR 1.09

/* Rounding of lengths that were made equal by solving for feeds that differ in their last digits. */
#define LENGTH_SLACK_MM 1e-10

#define BISECTIONS 60

struct ceiling {
    double feed_mm_s;
    enum governor governor;
};

static void ceiling_lower(struct ceiling *c, double feed_mm_s, enum governor governor)
{
    if (feed_mm_s < c->feed_mm_s) {
        c->feed_mm_s = feed_mm_s;
        c->governor = governor;
    }
}

/* Cruise feed on the arc: second v^2 <= ARC_ACCELERATION A, third v^3 <= ARC_JERK J. */
static struct ceiling block_ceiling(const struct block *b, double share)
{
    const struct block_shape *shape = &b->shape;
    struct ceiling c = {b->feed_cap_mm_s, b->governor};

    if (shape->first > 0.0) {
        const double a = shape->plane_a_mm_s2 * (1.0 - ACCELERATION_PER_SHARE * share);
        const double j = shape->plane_j_mm_s3 * (1.0 - share);

        ceiling_lower(&c, maths_sqrt(ARC_ACCELERATION * a / shape->second), GOVERNOR_ACCELERATION);
        ceiling_lower(&c, maths_cbrt(ARC_JERK * j / shape->third), GOVERNOR_JERK);
    }
    return c;
}

/* What an arc at feed v leaves for a ramp: the formulas at the top solved for a and j. */
static void limit_arc_ramp(const struct block_shape *shape, double share, double v,
                           struct ramp_limits *r)
{
    const double a_max = shape->plane_a_mm_s2 * (1.0 - ACCELERATION_PER_SHARE * share);
    const double j_max = shape->plane_j_mm_s3 * (1.0 - share);
    const double normal = shape->second * v * v;
    const double along = maths_sqrt(a_max * a_max - normal * normal) / shape->first;
    const double turning = RAMP_NORMAL * j_max / (3.0 * shape->second * v);
    const double j = (RAMP_ALONG * j_max - shape->third * v * v * v) / shape->first;

    r->a_mm_s2 = maths_min(r->a_mm_s2, maths_min(along, turning));
    r->j_mm_s3 = maths_min(r->j_mm_s3, j);
}

void block_set_share(struct block *b, double share)
{
    const struct ceiling c = block_ceiling(b, share);

    b->share = share;
    b->feed_max_mm_s = c.feed_mm_s;
    b->ramp.a_mm_s2 = b->shape.line_a_mm_s2 * (1.0 - ACCELERATION_PER_SHARE * share);
    b->ramp.j_mm_s3 = b->shape.line_j_mm_s3 * (1.0 - share);
    if (b->shape.first > 0.0) {
        limit_arc_ramp(&b->shape, share, b->feed_max_mm_s, &b->ramp);
    }
}

void block_cap_feed(struct block *b, double feed_mm_s, enum governor governor)
{
    if (feed_mm_s < b->feed_cap_mm_s) {
        b->feed_cap_mm_s = feed_mm_s;
        b->governor = governor;
        block_set_share(b, b->share);
    }
}

double block_top_feed(const struct block *b)
{
    return block_ceiling(b, 0.0).feed_mm_s;
}

enum governor block_governor(const struct block *b)
{
    return block_ceiling(b, b->share).governor;
}

/*
 * A ramp down to m > 0 can be longer than the ramp to a stop: (v + m) sqrt(v - m) / sqrt(j) is largest at m = v/3, by
 * 4/3 sqrt(2/3) = 1.0887. So the highest start feed is that for the planned end or that for a stop, whichever is
 * higher; and where the end feed must be free to take any value, because it is used for landing or because it is not
 * known yet, the longest of all these ramps must fit.
 */
double block_start_feed(const struct block *b)
{
    if (!b->closed || b->end == JOINT_REDUCED) {
        return ramp_reach(0.0, b->length_mm / RAMP_DETOUR, &b->ramp);
    }
    return maths_max(ramp_reach(0.0, b->length_mm, &b->ramp),
                     ramp_reach(b->feed_end_mm_s, b->length_mm, &b->ramp));
}

double block_end_feed(const struct block *b, double start_mm_s)
{
    double high = maths_min(b->feed_end_mm_s, ramp_reach(start_mm_s, b->length_mm, &b->ramp));
    double low = 0.0;

    if (high >= start_mm_s ||
        ramp_length(start_mm_s, high, &b->ramp) <= b->length_mm + LENGTH_SLACK_MM) {
        return high;
    }
    for (int i = 0; i < BISECTIONS; i++) {
        const double middle = 0.5 * (low + high);

        if (ramp_length(start_mm_s, middle, &b->ramp) <= b->length_mm) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

/* Limits of one axis that moves straight (or, beside a spiral arc, nearly so) along the path. */
static void limit_line_axis(struct block_shape *shape, struct ceiling *c,
                            const struct curve_bounds *bounds, const struct plan_limits *limits,
                            int i)
{
    const double a = limits->acceleration_mm_s2[i];
    const double j = limits->jerk_mm_s3[i];
    const double part = bounds->second[i] > 0.0 ? 1.0 - 2.0 * SPIRAL_PART : 1.0;

    if (bounds->first[i] > 0.0) {
        shape->line_a_mm_s2 = maths_min(shape->line_a_mm_s2, part * a / bounds->first[i]);
        shape->line_j_mm_s3 = maths_min(shape->line_j_mm_s3, part * j / bounds->first[i]);
    }
    if (bounds->second[i] > 0.0) {
        ceiling_lower(c, maths_sqrt(SPIRAL_PART * a / bounds->second[i]), GOVERNOR_ACCELERATION);
        ceiling_lower(c,
                      maths_cbrt(SPIRAL_PART * j / maths_max(bounds->third[i], bounds->second[i])),
                      GOVERNOR_JERK);
    }
}

/* Largest radius change per radian turned, as a part of the radius: how far from normal an arc's x_ss may be. */
static double spiral_ratio(const struct curve *curve)
{
    return maths_abs(curve->arc.radius_change_mm) /
           (curve->arc.radius_start_mm * maths_abs(curve->arc.sweep_rad));
}

/* Chord error: v = (2/cycle) sqrt(2 R d - d^2) (cycle-frequency page, (3) turned round); R <= d needs none. */
static double chord_feed(double radius_mm, double chord_mm, double cycle_s)
{
    if (radius_mm <= chord_mm) {
        return MATHS_INFINITY;
    }
    return 2.0 / cycle_s * maths_sqrt(chord_mm * (2.0 * radius_mm - chord_mm));
}

static void limit_arc_plane(struct block_shape *shape, struct ceiling *c, const struct curve *curve,
                            const struct curve_bounds *bounds, const struct plan_limits *limits)
{
    const int first = curve->arc.first;
    const int second = curve->arc.second;
    const double spiral = spiral_ratio(curve);

    shape->first = bounds->first[first];
    shape->second = bounds->second[first];
    shape->third = bounds->third[first];
    shape->plane_a_mm_s2 =
        maths_min(limits->acceleration_mm_s2[first], limits->acceleration_mm_s2[second]) /
        (1.0 + spiral);
    shape->plane_j_mm_s3 =
        maths_min(limits->jerk_mm_s3[first], limits->jerk_mm_s3[second]) / (1.0 + 3.0 * spiral);
    ceiling_lower(c, chord_feed(bounds->radius_min_mm, limits->chord_error_max_mm, limits->cycle_s),
                  GOVERNOR_CHORD);
}

void block_set_motion(struct block *b, const struct move *move, const struct curve *curve,
                      const struct plan_limits *limits)
{
    struct curve_bounds bounds;
    struct ceiling c = {move->feed_mm_s, GOVERNOR_PROGRAM};

    if (move->kind == MOVE_RAPID) {
        c = (struct ceiling){MATHS_INFINITY, GOVERNOR_VELOCITY};
    }
    memset(b, 0, sizeof(*b));
    b->move = *move;
    b->length_mm = curve->length_mm;
    b->rotary = curve_is_rotary(curve);
    b->end = JOINT_STOP;
    b->shape.line_a_mm_s2 = MATHS_INFINITY;
    b->shape.line_j_mm_s3 = MATHS_INFINITY;
    curve_bound(curve, &bounds);
    for (int i = 0; i < AXIS_COUNT; i++) {
        if (bounds.first[i] > 0.0) {
            ceiling_lower(&c, limits->velocity_mm_s[i] / bounds.first[i], GOVERNOR_VELOCITY);
        }
        if (curve->kind != CURVE_ARC || (i != curve->arc.first && i != curve->arc.second)) {
            limit_line_axis(&b->shape, &c, &bounds, limits, i);
        }
    }
    if (curve->kind == CURVE_ARC) {
        limit_arc_plane(&b->shape, &c, curve, &bounds, limits);
    }
    ceiling_lower(&c, CYCLE_BLOCKS_MAX * b->length_mm / limits->cycle_s, GOVERNOR_SHORT);
    b->feed_cap_mm_s = c.feed_mm_s;
    b->governor = c.governor;
    block_set_share(b, BLOCK_SHARE_MAX);
}

void block_set_wait(struct block *b, const struct move *move)
{
    memset(b, 0, sizeof(*b));
    b->move = *move;
    b->end = JOINT_STOP;
    b->closed = true;
}
