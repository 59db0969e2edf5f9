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

/* An axis outside the plane of an arc of two radii accelerates a little at constant feed: at most this part. */
#define SPIRAL_PART 0.1

/* A block lasts at least cycle / CYCLE_BLOCKS_MAX, so that a cycle passes a bounded number of joints. */
#define CYCLE_BLOCKS_MAX 8.0

/* Ramp to a third of the feed against ramp to a stop, rounded up: see block_start_feed. */
#define RAMP_DETOUR 1.09

/* Feeds solved for so that a ramp fills its block are rounded: by less than this part of them. */
#define FEED_SLACK 2e-15

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

/*
 * Does the ramp down fit? Judged by feeds, not by length: a change of feed by one unit in the last place takes a length
 * of 2 v sqrt(ulp(v)/j), which at a high feed and a low jerk is any part of a short block.
 */
static bool fits_down(const struct block *b, double start_mm_s, double end_mm_s)
{
    const double from = maths_max(end_mm_s, start_mm_s * (1.0 - FEED_SLACK));

    return ramp_length(from, end_mm_s, &b->ramp) <= b->length_mm * (1.0 + FEED_SLACK);
}

double block_end_feed(const struct block *b, double start_mm_s)
{
    double high = maths_min(b->feed_end_mm_s, ramp_reach(start_mm_s, b->length_mm, &b->ramp));
    double low = 0.0;

    if (high >= start_mm_s || fits_down(b, start_mm_s, high)) {
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

/*
 * Limits of one axis that moves straight along the path, or, beside an arc of two radii, nearly so: with
 * u = second v^2 / A and w = (third v^3 + 3 second v a) / J it keeps u <= SPIRAL_PART and both terms of w <= SPIRAL_PART / 2
 * at the highest feed v, and leaves 1 - 2u and 1 - 2w to a and j. The factor 2 = 1 / (1 - BLOCK_SHARE_MAX): what joints
 * take is taken from a and j alone.
 */
static void limit_line_axis(struct block_shape *shape, struct ceiling *c,
                            const struct curve_bounds *bounds, const struct plan_limits *limits,
                            int i)
{
    const double second = bounds->second[i];
    double a = limits->acceleration_mm_s2[i];
    double j = limits->jerk_mm_s3[i];

    if (second > 0.0) {
        const double part_j = 0.5 * SPIRAL_PART * j;

        ceiling_lower(c, maths_sqrt(SPIRAL_PART * a / second), GOVERNOR_ACCELERATION);
        ceiling_lower(c, maths_cbrt(part_j / bounds->third[i]), GOVERNOR_JERK);
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

/* Chord error: v = (2/cycle) sqrt(2 R d - d^2) (cycle-frequency page, (3) turned round); R <= d needs none. */
static double chord_feed(double radius_mm, double chord_mm, double cycle_s)
{
    if (radius_mm <= chord_mm) {
        return MATHS_INFINITY;
    }
    return 2.0 / cycle_s * maths_sqrt(chord_mm * (2.0 * radius_mm - chord_mm));
}

/*
 * On an arc of two radii x_ss and x_sss are not quite normal to the path and along it. What the formulas at the top
 * miss is at most along (second v^2) in acceleration, and along (3 second v a) + across (third v^3) in jerk.
 */
static void limit_arc_plane(struct block_shape *shape, struct ceiling *c, const struct curve *curve,
                            const struct curve_bounds *bounds, const struct plan_limits *limits)
{
    const int first = curve->arc.first;
    const int second = curve->arc.second;
    const double along = bounds->second_along / bounds->second[first];
    const double across = bounds->third_across / bounds->third[first];

    shape->first = bounds->first[first];
    shape->second = bounds->second[first];
    shape->third = bounds->third[first];
    shape->plane_a_mm_s2 =
        maths_min(limits->acceleration_mm_s2[first], limits->acceleration_mm_s2[second]) /
        (1.0 + ARC_ACCELERATION * along);
    shape->plane_j_mm_s3 = maths_min(limits->jerk_mm_s3[first], limits->jerk_mm_s3[second]) /
                           (1.0 + RAMP_NORMAL * along + ARC_JERK * across);
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
    }
    for (int i = 0; i < AXIS_COUNT; i++) {
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
