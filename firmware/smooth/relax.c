/*
 * Looks for control points c that keep all of these (alternating directions, Boyd et al. 2011, section 5):
 *     the curve at every sample (c[i-1] + 4 c[i] + c[i+1])/6 and at every corner within the tolerance of the route,
 *     |c[i-1] - 2 c[i] + c[i+1]| <= A d^2 and |c[i+2] - 3 c[i+1] + 3 c[i] - c[i-1]| <= J d^3 on every axis.
 * With K the rows, z the nearest values that are allowed, u the sums of what was missing and R the weights, one
 * iteration is c += (K' R K)^-1 K' R (z - u - K c), z = nearest(K c + u), u += K c - z. The matrix has three bands beside
 * its diagonal. Where the timing asks for too much there is no such c; the last iterations then favour the tolerance,
 * and the timing is changed.
 */
#include "smooth/relax.h"

#include "base/maths.h"

#include <string.h>

/* Over-relaxation. */
#define OVER 1.6

/* The last iterations weigh the tolerance so many times more. */
#define LAST        8
#define LAST_FAVOUR 30.0

/* Part of the axes' limits the boxes have: feed changes need the rest (judge.c). */
#define BOX_BEND  0.965
#define BOX_TWIST 0.945

/* How much less acceleration and jerk are preferred to more, inside their boxes. */
#ifndef CALM
#define CALM 0.3
#endif

/* Corners that turn less need no condition of their own. */
#define CORNER_MIN 0.005

/* A mean direction shorter than this belongs to a reversal. */
#define REVERSAL 0.3

/* Weights beyond this, relative to that of the tolerance, would leave too few digits. */
#define WEIGHT_MAX 1e5

/* On the diagonal: this sample stays where it is. */
#define FIXED 1e30

static bool has_axis(const struct route *r, int axis)
{
    return (r->limits.axes >> axis & 1U) != 0;
}

static double near_of(const double *c, unsigned i)
{
    return (c[i - 1] + 4.0 * c[i] + c[i + 1]) / 6.0;
}

static double bend_of(const double *c, unsigned i)
{
    return c[i - 1] - 2.0 * c[i] + c[i + 1];
}

static double twist_of(const double *c, unsigned i)
{
    return c[i + 2] - 3.0 * c[i + 1] + 3.0 * c[i] - c[i - 1];
}

static double corner_of(const struct relax_corner *k, const double *c)
{
    const double *at = c + k->piece;

    return k->weight[0] * at[0] + k->weight[1] * at[1] + k->weight[2] * at[2] +
           k->weight[3] * at[3];
}

static double box_bend(const struct route *r, const struct window *w, int axis)
{
    return BOX_BEND * r->limits.acceleration_mm_s2[axis] * w->interval_s * w->interval_s;
}

static double box_twist(const struct route *r, const struct window *w, int axis)
{
    const double d = w->interval_s;

    return BOX_TWIST * r->limits.jerk_mm_s3[axis] * d * d * d;
}

/* Where the curve passes the start of an element: the piece and the fraction by the places of its samples. */
static bool set_corner(struct relax_corner *k, const struct window *w, const struct route *r,
                       uint32_t element, unsigned *sample)
{
    const double at = route_element(r, element)->start_mm;
    unsigned i = *sample;
    struct point before;
    struct point after;
    double square = 0.0;

    while (i + 2 < w->count && w->at_mm[i + 1] <= at) {
        i++;
    }
    *sample = i;
    if (i + 2 >= w->count || w->at_mm[i] > at) {
        return false;
    }
    k->piece = i - 1;
    k->element = element;
    window_weights((at - w->at_mm[i]) / (w->at_mm[i + 1] - w->at_mm[i]), k->weight);
    route_corner(r, element, &before, &after);
    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        k->along.at[axis] = before.at[axis] + after.at[axis];
        square += k->along.at[axis] * k->along.at[axis];
    }
    const double length = maths_sqrt(square);

    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        k->along.at[axis] = length > REVERSAL ? k->along.at[axis] / length : 0.0;
    }
    return true;
}

static void find_corners(struct relax *x, const struct window *w, const struct route *r)
{
    unsigned sample = 1;

    x->corners = 0;
    for (uint32_t e = w->element[1] + 1; e < r->count && x->corners < RELAX_CORNERS_MAX; e++) {
        if (route_element(r, e)->start_mm > w->at_mm[w->count - 2]) {
            return;
        }
        if (route_element(r, e)->turn > CORNER_MIN &&
            set_corner(&x->corner[x->corners], w, r, e, &sample)) {
            x->corners++;
        }
    }
}

static void start_axis(struct relax *x, const struct window *w, const struct route *r, int axis)
{
    const double *c = w->x[axis];
    const double bend = box_bend(r, w, axis);
    const double twist = box_twist(r, w, axis);

    for (unsigned i = 1; i + 2 < w->count; i++) {
        x->near.goal[axis][i] = near_of(c, i);
        x->bend.goal[axis][i] = maths_clamp(bend_of(c, i), -bend, bend);
        x->twist.goal[axis][i] = maths_clamp(twist_of(c, i), -twist, twist);
    }
    for (unsigned k = 0; k < x->corners; k++) {
        x->corner[k].goal.at[axis] = corner_of(&x->corner[k], c);
        x->corner[k].sum.at[axis] = 0.0;
    }
    memset(x->near.sum[axis], 0, sizeof x->near.sum[axis]);
    memset(x->bend.sum[axis], 0, sizeof x->bend.sum[axis]);
    memset(x->twist.sum[axis], 0, sizeof x->twist.sum[axis]);
    x->weight_bend[axis] = maths_min(1.0 / (bend * bend), WEIGHT_MAX * x->weight_near);
    x->weight_twist[axis] = maths_min(1.0 / (twist * twist), WEIGHT_MAX * x->weight_near);
}

/* Adds weight (row' row) to the bands, for a row of so many neighbours from first on. */
static void add_row(struct relax_bands *b, unsigned first, const double *row, unsigned width,
                    double weight)
{
    double *const band[4] = {b->d0, b->d1, b->d2, b->d3};

    for (unsigned i = 0; i < width; i++) {
        for (unsigned k = i; k < width; k++) {
            band[k - i][first + i] += weight * row[i] * row[k];
        }
    }
}

static void build(struct relax_bands *b, const struct relax *x, const struct window *w, int axis)
{
    static const double near[3] = {1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0};
    static const double bend[3] = {1.0, -2.0, 1.0};
    static const double twist[4] = {-1.0, 3.0, -3.0, 1.0};

    memset(b, 0, sizeof(*b));
    for (unsigned i = 1; i + 2 < w->count; i++) {
        add_row(b, i - 1, near, 3, x->weight_near);
        add_row(b, i - 1, bend, 3, x->weight_bend[axis]);
        add_row(b, i - 1, twist, 4, x->weight_twist[axis]);
    }
    for (unsigned k = 0; k < x->corners; k++) {
        add_row(b, x->corner[k].piece, x->corner[k].weight, 4, x->weight_near);
    }
    for (unsigned i = 0; i < SMOOTH_FIXED; i++) {
        b->d0[i] = FIXED;
        b->d0[w->count - 1 - i] = FIXED;
    }
}

/* L D L' with three bands; the multipliers take the bands' places. Nothing lies beyond the last sample. */
static void factor(struct relax_bands *b, unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        const double l1 = b->d1[i] / b->d0[i];
        const double l2 = b->d2[i] / b->d0[i];
        const double l3 = b->d3[i] / b->d0[i];

        if (i + 1 < count) {
            b->d0[i + 1] -= l1 * b->d1[i];
            b->d1[i + 1] -= l1 * b->d2[i];
            b->d2[i + 1] -= l1 * b->d3[i];
        }
        if (i + 2 < count) {
            b->d0[i + 2] -= l2 * b->d2[i];
            b->d1[i + 2] -= l2 * b->d3[i];
        }
        if (i + 3 < count) {
            b->d0[i + 3] -= l3 * b->d3[i];
        }
        b->d1[i] = l1;
        b->d2[i] = l2;
        b->d3[i] = l3;
    }
}

static void solve(const struct relax_bands *b, double *v, unsigned count)
{
    for (unsigned i = 0; i + 3 < count; i++) {
        v[i + 1] -= b->d1[i] * v[i];
        v[i + 2] -= b->d2[i] * v[i];
        v[i + 3] -= b->d3[i] * v[i];
    }
    v[count - 2] -= b->d1[count - 3] * v[count - 3];
    v[count - 1] -= b->d2[count - 3] * v[count - 3] + b->d1[count - 2] * v[count - 2];
    for (unsigned i = 0; i < count; i++) {
        v[i] /= b->d0[i];
    }
    v[count - 2] -= b->d1[count - 2] * v[count - 1];
    v[count - 3] -= b->d1[count - 3] * v[count - 2] + b->d2[count - 3] * v[count - 1];
    for (unsigned i = count - 3; i > 0; i--) {
        v[i - 1] -= b->d1[i - 1] * v[i] + b->d2[i - 1] * v[i + 1] + b->d3[i - 1] * v[i + 2];
    }
}

/* K' R (z - u - K c) of one axis. */
static void residual(const struct relax *x, const struct window *w, int axis, double *v)
{
    const double *c = w->x[axis];

    memset(v, 0, w->count * sizeof v[0]);
    for (unsigned i = 1; i + 2 < w->count; i++) {
        const double near =
            x->weight_near / 6.0 * (x->near.goal[axis][i] - x->near.sum[axis][i] - near_of(c, i));
        const double bend =
            x->weight_bend[axis] * (x->bend.goal[axis][i] - x->bend.sum[axis][i] - bend_of(c, i));
        const double twist = x->weight_twist[axis] *
                             (x->twist.goal[axis][i] - x->twist.sum[axis][i] - twist_of(c, i));

        v[i - 1] += near + bend - twist;
        v[i] += 4.0 * near - 2.0 * bend + 3.0 * twist;
        v[i + 1] += near + bend - 3.0 * twist;
        v[i + 2] += twist;
    }
    for (unsigned k = 0; k < x->corners; k++) {
        const struct relax_corner *q = &x->corner[k];
        const double e = x->weight_near * (q->goal.at[axis] - q->sum.at[axis] - corner_of(q, c));

        for (unsigned i = 0; i < 4; i++) {
            v[q->piece + i] += q->weight[i] * e;
        }
    }
    for (unsigned i = 0; i < SMOOTH_FIXED; i++) {
        v[i] = 0.0;
        v[w->count - 1 - i] = 0.0;
    }
}

static void move_axis(struct relax *x, struct window *w, int axis)
{
    double *v = x->step[axis];

    residual(x, w, axis, v);
    solve(&x->bands[axis], v, w->count);
    for (unsigned i = SMOOTH_FIXED; i + SMOOTH_FIXED < w->count; i++) {
        w->x[axis][i] += v[i];
    }
}

/* z and u of a row whose value is now and must lie in -limit ... limit. */
static void into_box(double now, double limit, double *goal, double *sum)
{
    const double t = OVER * now + (1.0 - OVER) * *goal + *sum;

    *goal = maths_clamp(t / (1.0 + CALM), -limit, limit);
    *sum = t - *goal;
}

static void boxes(struct relax *x, const struct window *w, const struct route *r, int axis)
{
    const double *c = w->x[axis];
    const double bend = box_bend(r, w, axis);
    const double twist = box_twist(r, w, axis);

    for (unsigned i = 1; i + 2 < w->count; i++) {
        into_box(bend_of(c, i), bend, &x->bend.goal[axis][i], &x->bend.sum[axis][i]);
        into_box(twist_of(c, i), twist, &x->twist.goal[axis][i], &x->twist.sum[axis][i]);
    }
}

/* z and u of the curve at a sample: within the tolerance of its foot. */
static void into_tube(struct relax *x, const struct window *w, const struct route *r,
                      double tolerance_mm, unsigned i)
{
    struct route_foot foot = {.element = w->element[i], .at_mm = w->at_mm[i]};
    struct point t;
    double from;
    double to;

    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        t.at[axis] = OVER * near_of(w->x[axis], i) + (1.0 - OVER) * x->near.goal[axis][i] +
                     x->near.sum[axis][i];
    }
    window_reach(w, i, &from, &to);
    route_foot(r, &t, from, to, &foot);
    const double part = foot.distance_mm > tolerance_mm ? tolerance_mm / foot.distance_mm : 1.0;

    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        const double goal = foot.point.at[axis] + part * (t.at[axis] - foot.point.at[axis]);

        x->near.goal[axis][i] = goal;
        x->near.sum[axis][i] = t.at[axis] - goal;
    }
}

/* z and u of the curve at a corner: what lies across the mean direction is within the tolerance. */
static void into_corner(struct relax_corner *k, const struct window *w, const struct route *r,
                        double tolerance_mm)
{
    const struct point *corner = &route_element(r, k->element)->curve.start;
    struct point t;
    double along = 0.0;
    double square = 0.0;

    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        t.at[axis] =
            OVER * corner_of(k, w->x[axis]) + (1.0 - OVER) * k->goal.at[axis] + k->sum.at[axis];
        along += smooth_weight(axis) * (t.at[axis] - corner->at[axis]) * k->along.at[axis];
    }
    struct point across;

    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        across.at[axis] =
            t.at[axis] - corner->at[axis] - along * k->along.at[axis] / smooth_weight(axis);
        square += across.at[axis] * across.at[axis] * smooth_weight(axis) * smooth_weight(axis);
    }
    const double distance = maths_sqrt(square);
    const double less = distance > tolerance_mm ? 1.0 - tolerance_mm / distance : 0.0;

    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        k->sum.at[axis] = less * across.at[axis];
        k->goal.at[axis] = t.at[axis] - k->sum.at[axis];
    }
}

static void build_all(struct relax *x, const struct window *w, const struct route *r)
{
    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        if (has_axis(r, axis)) {
            build(&x->bands[axis], x, w, axis);
            factor(&x->bands[axis], w->count);
        }
    }
}

/* From here on the tolerance counts more; what it has summed up is in units of its weight. */
static void favour_tolerance(struct relax *x, const struct window *w, const struct route *r)
{
    x->weight_near *= LAST_FAVOUR;
    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        for (unsigned i = 0; i < w->count; i++) {
            x->near.sum[axis][i] /= LAST_FAVOUR;
        }
        for (unsigned k = 0; k < x->corners; k++) {
            x->corner[k].sum.at[axis] /= LAST_FAVOUR;
        }
    }
    build_all(x, w, r);
}

static void iterate(struct relax *x, struct window *w, const struct route *r, double tolerance_mm)
{
    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        if (has_axis(r, axis)) {
            move_axis(x, w, axis);
            boxes(x, w, r, axis);
        }
    }
    for (unsigned i = 1; i + 2 < w->count; i++) {
        into_tube(x, w, r, tolerance_mm, i);
    }
    for (unsigned k = 0; k < x->corners; k++) {
        into_corner(&x->corner[k], w, r, tolerance_mm - r->limits.chord_mm);
    }
}

void relax_window(struct relax *x, struct window *w, const struct route *r, double tolerance_mm,
                  unsigned iterations)
{
    find_corners(x, w, r);
    x->weight_near = 1.0 / (tolerance_mm * tolerance_mm);
    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        start_axis(x, w, r, axis);
    }
    build_all(x, w, r);
    for (unsigned i = 0; i < iterations; i++) {
        if (i + LAST == iterations) {
            favour_tolerance(x, w, r);
        }
        iterate(x, w, r, tolerance_mm);
    }
}
