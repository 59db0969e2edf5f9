#include "ahead/window.h"

#include "ahead/excess.h"
#include "convex/vector.h"

#include <string.h>

/* A closest point is beside the curve when the way to it is across the path but for this. */
#define BESIDE_PART 0.05
#define BESIDE_MM   1e-6

/* The least part of the tolerance that is used. */
#define LEAST_PART 0.3

/* Weights of four control points: derivatives at an interval's first knot, and at its middle. */
static const double knot_value[4] = {1.0 / 6, 4.0 / 6, 1.0 / 6, 0};
static const double knot_first[4] = {-0.5, 0, 0.5, 0};
static const double difference[4] = {-1, 1, 0, 0}; /* of control points: bounds velocity */
static const double difference_value[4] = {0.5, 0.5, 0, 0};
static const double knot_second[4] = {1, -2, 1, 0};
static const double next_second[4] = {0, 1, -2, 1};
static const double middle_value[4] = {1.0 / 48, 23.0 / 48, 23.0 / 48, 1.0 / 48};
static const double middle_first[4] = {-1.0 / 8, -5.0 / 8, 5.0 / 8, 1.0 / 8};
static const double middle_second[4] = {0.5, -0.5, -0.5, 0.5};
static const double third[4] = {-1, 3, -3, 1};

static double of_axis(double (*control)[3], const double weight[4], int axis)
{
    return weight[0] * control[0][axis] + weight[1] * control[1][axis] +
           weight[2] * control[2][axis] + weight[3] * control[3][axis];
}

/* The rows of one axis, see problem.h. */
static void set_axis(const struct problem *p, struct problem_cell *cell, double (*control)[3],
                     int axis)
{
    const double *scale = p->scale[axis];
    const double d1 = of_axis(control, difference, axis);
    const double q1 = of_axis(control, knot_first, axis);
    const double q2 = of_axis(control, knot_second, axis);
    const double m1 = of_axis(control, middle_first, axis);
    const double m2 = of_axis(control, middle_second, axis);
    const double m3 = of_axis(control, third, axis);

    cell->now[axis][FORM_VELOCITY] = scale[FORM_VELOCITY] * d1;
    cell->now[axis][FORM_ACCELERATION] = scale[FORM_ACCELERATION] * q2;
    cell->now[axis][FORM_JERK] = scale[FORM_JERK] * m3;
    for (int k = 0; k < 4; k++) {
        cell->time[axis][FORM_VELOCITY][k] = scale[FORM_VELOCITY] * 0.5 * d1 * difference_value[k];
        cell->time[axis][FORM_ACCELERATION][k] =
            scale[FORM_ACCELERATION] * (q2 * knot_value[k] + 0.5 * q1 * knot_first[k]);
        cell->time[axis][FORM_JERK][k] =
            scale[FORM_JERK] *
            (m3 * middle_value[k] + 1.5 * m2 * middle_first[k] + 0.5 * m1 * middle_second[k]);
    }
}

/* |q' + d' + q' e / 2| <= F */
static void set_feed(const struct window *w, struct problem_cell *cell, double (*control)[3],
                     double feed_mm_s)
{
    const double limit = feed_mm_s * w->limits->step_s;
    double way[3];

    trail_sum(control, difference, way);
    cell->feed_scale = 0;
    if (!maths_is_finite(limit) || vector_length(way) < 0.5 * limit)
        return;
    cell->feed_scale = 1 / limit;
    for (int i = 0; i < 3; i++)
        cell->feed_now[i] = way[i] / limit;
}

/*
 * No more acceleration than all axes may have, mm a knot squared; what modes make of it has no such
 * bound.
 */
static double most_bend(const struct ahead_limits *l)
{
    return l->modes.count > 0 ? MATHS_INFINITY
                              : vector_length(l->acceleration_mm_s2) * l->step_s * l->step_s;
}

/* The larger of an interval's accelerations at its ends. */
static double bend_of(const struct ahead_limits *l, double (*control)[3])
{
    double here[3];
    double next[3];

    trail_sum(control, knot_second, here);
    trail_sum(control, next_second, next);
    return maths_min(most_bend(l), maths_max(vector_length(here), vector_length(next)));
}

/* By what setpoints in place of the motors' curve move the tool in interval k, at most. */
static double lag_of(const struct window *w, size_t k)
{
    double away[3];

    vector_from_to(w->trail->motor[k + 1], w->trail->tool[k + 1], away);
    return w->limits->modes.lag * vector_length(away);
}

/*
 * In interval k, between places t knots apart, the tool's curve bends away by a t^2 / 8: half a
 * knot for the path, a cycle for its junctions, which are verified by the straight lines between
 * setpoints. It is the acceleration that there is, not the limit: else a higher limit would narrow
 * the tolerance.
 */
static double radius_of(const struct window *w, const struct ahead_element *e, size_t k, double t)
{
    const double sag_mm = bend_of(w->limits, w->trail->tool + k) * t * t / 8 + lag_of(w, k);
    const double least_mm = LEAST_PART * e->tolerance_mm;

    return maths_max(least_mm, maths_min(w->inside * e->tolerance_mm,
                                         EXCESS_TOLERANCE_PART * e->tolerance_mm - sag_mm));
}

/* Is x beside its closest point, not before or behind it as at a corner? */
static bool is_beside(const struct problem_ball *ball)
{
    const double along = vector_dot(ball->offset, ball->along);

    return maths_abs(along) <= BESIDE_PART * vector_length(ball->offset) + BESIDE_MM;
}

/*
 * Within reach of its closest point: the path may be left sideways only; a corner in no direction.
 */
static void set_tube(const struct window *w, struct problem_ball *ball, size_t k,
                     const double weight[4], double place_mm, size_t *hint)
{
    const struct ahead_element *e;
    double closest[3];
    double x[3];

    *hint = ahead_path_find(w->path, place_mm, *hint);
    e = &w->path->element[*hint];
    ahead_path_at(w->path, *hint, place_mm, closest, ball->along);
    trail_sum(w->trail->tool + k, weight, x);
    vector_from_to(closest, x, ball->offset);
    if (!is_beside(ball))
        memset(ball->along, 0, sizeof ball->along);
    memcpy(ball->weight, weight, sizeof ball->weight);
    ball->radius_mm = radius_of(w, e, k, 0.5);
}

/*
 * A stray tool is wherever it has got to: its closest point of the path is no farther along the
 * path than twice as far as it is from the tool.
 */
static void set_stray_ball(const struct window *w, struct problem_ball *ball, size_t s, size_t k,
                           const double weight[4], double place_mm, size_t hint)
{
    const struct trail *t = w->trail;
    const struct ahead_element *e;
    struct ahead_closest closest;
    double tool[3];
    double away[3];
    double x[3];

    trail_sum(t->tool + k, weight, tool);
    trail_sum(t->stray[s] + k, weight, x);
    vector_from_to(tool, x, away);
    ahead_path_closest(w->path, x, place_mm, EXCESS_REACH_MM + 2 * vector_length(away), hint,
                       &closest);
    vector_copy(closest.tangent, ball->along);
    vector_from_to(closest.point, x, ball->offset);
    if (!is_beside(ball))
        memset(ball->along, 0, sizeof ball->along);
    memcpy(ball->weight, weight, sizeof ball->weight);
    e = &w->path->element[closest.element];
    ball->radius_mm = e->exact ? 0 : STRAY_TOLERANCES * radius_of(w, e, k, 0.5);
}

/*
 * The row about the second of three control points: weights of modes.h; time as problem.h has it, E
 * and q both being curves.
 */
static void set_swing(const struct window *w, struct problem_swing *row, size_t s, size_t k,
                      int axis, const struct problem_side *motor)
{
    const struct modes_stray *as = &w->limits->modes.stray[s][axis];
    const unsigned modes = w->trail->modes;
    const double own[3] = {as->determinant, -as->trace, 1};
    static const double second[3] = {1, -2, 1};
    double q[3];
    double e[3];

    memset(row, 0, sizeof *row);
    for (size_t n = 0; n < 3; n++) {
        q[n] = w->trail->motor[k + n][axis];
        e[n] = w->trail->stray[s][k + n][axis] - q[n];
        row->by_own[n] = own[n];
        for (size_t i = 0; i < 1 + 2 * (size_t)modes; i++) {
            const double weight = as->pull * second[n] - own[n];

            row->by_curve[n + i] += weight * motor->by_curve[n][axis][i];
            row->by_time[n + i] += weight * motor->by_time[n][axis][i];
        }
    }
    if (as->part == 0)
        return;
    const double scale = as->pull / as->part;
    const double e1 = 0.5 * (e[2] - e[0]);
    const double first = e1 + as->part * 0.5 * (q[2] - q[0]);
    const double bend = e[2] - 2 * e[1] + e[0] + as->part * (q[2] - 2 * q[1] + q[0]);

    row->by_time[1 + modes] += scale * (bend + as->drag * e1);
    row->by_time[2 + modes] += scale * 0.25 * first;
    row->by_time[0 + modes] -= scale * 0.25 * first;
}

static void set_strays(struct problem *p, const struct window *w, size_t i, const double *place_mm,
                       size_t hint)
{
    for (size_t s = 0; s < p->strays; s++) {
        struct problem_stray *stray = &p->stray[i][s];

        set_stray_ball(w, &stray->ball[0], s, w->first + i, knot_value, place_mm[0], hint);
        set_stray_ball(w, &stray->ball[1], s, w->first + i, middle_value, place_mm[1], hint);
        for (int k = 2; k < STRAY_BALLS; k++)
            stray->ball[k].radius_mm = 0;
        for (int axis = 0; axis < 3; axis++)
            set_swing(w, &stray->swing[axis], s, w->first + i, axis, &p->map[i].motor);
    }
}

/* A curve that has to come near the path's junctions, and where its balls are. */
struct passer {
    double (*control)[3];
    double tolerances;
    int stray; /* -1: the tool itself */
};

/* Where a curve is nearest to a point, from the half knot nearest to it on. */
static double nearest_knot(const struct trail *t, double (*control)[3], const double corner[3],
                           double u)
{
    const double last = (double)t->intervals;

    for (int i = 0; i < 4; i++) {
        const double v = maths_clamp(u, 0, last - 1e-9);
        const size_t k = (size_t)v;
        double weight[4];
        double x[3];
        double slope[3];
        double way[3];
        double square;

        trail_weights(v - (double)k, weight);
        trail_sum(control + k, weight, x);
        trail_slopes(v - (double)k, weight);
        trail_sum(control + k, weight, slope);
        vector_from_to(x, corner, way);
        square = vector_dot(slope, slope);
        if (square < 1e-16)
            return v;
        u = v + maths_clamp(vector_dot(way, slope) / square, -0.5, 0.5);
    }
    return maths_clamp(u, 0, last - 1e-9);
}

static double distance_at(const struct trail *t, double (*control)[3], size_t site,
                          const double corner[3])
{
    double x[3];
    double way[3];

    trail_at(t, control, 0.5 * (double)site, x);
    vector_from_to(x, corner, way);
    return vector_length(way);
}

/*
 * The half knot nearest to a corner: from where the path's corner is passed downhill, so that
 * another pass of a path that turns back on itself is not taken for it.
 */
static size_t nearest_site(const struct trail *t, double (*control)[3], const double corner[3],
                           size_t site, size_t first, size_t last)
{
    double here = distance_at(t, control, site, corner);

    while (site < last && distance_at(t, control, site + 1, corner) < here)
        here = distance_at(t, control, ++site, corner);
    while (site > first && distance_at(t, control, site - 1, corner) < here)
        here = distance_at(t, control, --site, corner);
    return site;
}

/* A free one of a cell's balls, or its last. */
static struct problem_ball *free_ball(const struct problem *p, size_t cell, int stray)
{
    struct problem_ball *ball = stray < 0 ? p->cell[cell].ball : p->stray[cell][stray].ball;
    const int balls = stray < 0 ? CELL_BALLS : STRAY_BALLS;
    int slot = 2;

    while (slot + 1 < balls && ball[slot].radius_mm > 0)
        slot++;
    return &ball[slot];
}

/*
 * The curve at u comes within reach of a junction; of a curved one sideways, so that it may still
 * move along.
 */
static void add_junction(struct problem *p, const struct window *w, const struct ahead_element *e,
                         const struct passer *by, double u)
{
    const size_t k = (size_t)u;
    struct problem_ball *ball;
    double x[3];
    double length;

    if (k < w->first || k >= w->first + p->cells)
        return;
    ball = free_ball(p, k - w->first, by->stray);
    trail_slopes(u - (double)k, ball->weight);
    trail_sum(by->control + k, ball->weight, ball->along);
    length = vector_length(ball->along);
    for (int i = 0; i < 3; i++)
        ball->along[i] = e->junction == AHEAD_CURVED && length > 0 ? ball->along[i] / length : 0;
    trail_weights(u - (double)k, ball->weight);
    trail_sum(by->control + k, ball->weight, x);
    vector_from_to(e->curve.end.at, x, ball->offset);
    ball->radius_mm = by->tolerances * radius_of(w, e, k, w->limits->cycle_s / w->limits->step_s);
}

static void pass_junctions(struct problem *p, const struct window *w, const struct passer *by)
{
    const struct trail *t = w->trail;
    const size_t last = 2 * (w->first + p->cells);
    const size_t first = 2 * w->first;
    size_t site = first;
    size_t k = ahead_path_find(w->path, t->place_mm[site], 0);

    for (; k + 1 < w->path->count && w->path->element[k + 1].start_mm < t->place_mm[last]; k++) {
        const struct ahead_element *e = &w->path->element[k];
        const double at_mm = w->path->element[k + 1].start_mm;
        const double *end = e->curve.end.at;

        if (e->junction == AHEAD_SMOOTH || (by->stray >= 0 && e->exact))
            continue;
        while (site < last && t->place_mm[site] < at_mm)
            site++;
        const size_t nearest = nearest_site(t, by->control, end, site, first, last);

        add_junction(p, w, e, by, nearest_knot(t, by->control, end, 0.5 * (double)nearest));
    }
}

static void set_junctions(struct problem *p, const struct window *w)
{
    pass_junctions(p, w, &(struct passer){w->trail->tool, 1, -1});
    for (int s = 0; s < (int)p->strays; s++)
        pass_junctions(p, w, &(struct passer){w->trail->stray[s], STRAY_TOLERANCES, s});
}

static void set_scales(struct problem *p, const struct ahead_limits *l)
{
    const double h = l->step_s;

    for (int i = 0; i < 3; i++) {
        p->scale[i][FORM_VELOCITY] = 1 / (l->velocity_mm_s[i] * h);
        p->scale[i][FORM_ACCELERATION] = 1 / (l->acceleration_mm_s2[i] * h * h);
        p->scale[i][FORM_JERK] = 1 / (l->jerk_mm_s3[i] * h * h * h);
    }
}

static void copy_weights(struct problem_side *side, size_t point, int axis,
                         const struct modes_point *from)
{
    memcpy(side->by_curve[point][axis], from->by_curve, sizeof from->by_curve);
    memcpy(side->by_time[point][axis], from->by_time, sizeof from->by_time);
}

/* How the control points of an interval go with those of w. */
static void set_map(struct problem_map *map, const struct ahead_modes *modes, double (*control)[3])
{
    for (size_t k = 0; k < 4; k++) {
        for (int axis = 0; axis < 3; axis++) {
            struct modes_point motor;
            struct modes_point tool;

            modes_at(modes, axis, control + k, &motor, &tool);
            copy_weights(&map->motor, k, axis, &motor);
            copy_weights(&map->tool, k, axis, &tool);
        }
    }
}

void window_build(struct problem *p, const struct window *w)
{
    size_t hint = 0;

    p->modes = w->trail->modes;
    p->rest = w->first + p->cells == w->trail->intervals ? w->trail->rest : 0;
    p->strays = p->modes > 0 ? w->limits->modes.strays : 0;
    set_scales(p, w->limits);
    for (size_t i = 0; i < p->cells; i++) {
        double(*motor)[3] = w->trail->motor + w->first + i;
        const double *place_mm = &w->trail->place_mm[2 * (w->first + i)];
        struct problem_cell *cell = &p->cell[i];

        for (int axis = 0; axis < 3; axis++)
            set_axis(p, cell, motor, axis);
        set_tube(w, &cell->ball[0], w->first + i, knot_value, place_mm[0], &hint);
        set_feed(w, cell, motor, w->path->element[hint].feed_mm_s);
        set_tube(w, &cell->ball[1], w->first + i, middle_value, place_mm[1], &hint);
        for (int k = 2; k < CELL_BALLS; k++)
            cell->ball[k].radius_mm = 0;
        if (p->modes > 0)
            set_map(&p->map[i], &w->limits->modes, w->trail->control + w->first + i);
        set_strays(p, w, i, place_mm, hint);
    }
    set_junctions(p, w);
}
