#include "ahead/warp.h"

#include "ahead/vector.h"

#include <stdlib.h>
#include <string.h>

/* The rate's square is not below this, whatever overshoots. */
#define SQUARE_MIN 0.04

/* How far along the path a foot is looked for: so many times the way of a knot, within bounds. */
#define REACH_PART   2.0
#define REACH_MIN_MM 0.06
#define REACH_MAX_MM 0.5

struct warp {
    const struct problem_window *w;
    size_t cells;
    double (*control)[3]; /* moved */
    double *square;       /* coefficients of y, cells + 3 */
    double *time;         /* of every knot, in old knots; cells + 1 */
    double stretch;       /* of time in the window's middle, to end on a whole knot */
};

static double spline_of(const double *coefficient, double f)
{
    double weight[4];

    trail_weights(f, weight);
    return weight[0] * coefficient[0] + weight[1] * coefficient[1] + weight[2] * coefficient[2] +
           weight[3] * coefficient[3];
}

static double slope_of(const double *coefficient, double f)
{
    double weight[4];

    trail_slopes(f, weight);
    return weight[0] * coefficient[0] + weight[1] * coefficient[1] + weight[2] * coefficient[2] +
           weight[3] * coefficient[3];
}

/* 1 at the window's middle and 0 at its ends, with its first two derivatives. */
static double bump(const struct warp *a, double u)
{
    const double x = u / (double)a->cells;
    const double b = 4 * x * (1 - x);

    return b * b * b;
}

/* dt / du = (1 + stretch bump) / sqrt(y) */
static double pace(const struct warp *a, size_t cell, double f)
{
    const double y = maths_max(spline_of(a->square + cell, f), SQUARE_MIN);

    return (1 + a->stretch * bump(a, (double)cell + f)) / maths_sqrt(y);
}

/* Simpson's rule over two halves of each interval. */
static double interval_time(const struct warp *a, size_t cell)
{
    return (pace(a, cell, 0) + 4 * pace(a, cell, 0.25) + 2 * pace(a, cell, 0.5) +
            4 * pace(a, cell, 0.75) + pace(a, cell, 1)) /
           12;
}

static double whole_time(struct warp *a)
{
    a->time[0] = 0;
    for (size_t i = 0; i < a->cells; i++)
        a->time[i + 1] = a->time[i] + interval_time(a, i);
    return a->time[a->cells];
}

/* Time is linear in the stretch. */
static size_t end_on_a_knot(struct warp *a)
{
    double plain;
    double stretched;
    size_t knots;

    a->stretch = 0;
    plain = whole_time(a);
    knots = (size_t)maths_ceil(plain - 1e-9);
    if (knots < TRAIL_ENDS + 1)
        knots = TRAIL_ENDS + 1;
    a->stretch = 1;
    stretched = whole_time(a);
    a->stretch = ((double)knots - plain) / (stretched - plain);
    (void)whole_time(a);
    return knots;
}

/*
 * The old knot u at a time within an interval: the polynomial of degree 5 with u, du/dt = 1 / pace and d2u/dt2 of both ends;
 * d2u/dt2 by the slope of y alone, the stretch is too slow to matter: u' = sqrt(y), u" = y' / 2.
 */
static double knot_at(const struct warp *a, size_t cell, double time)
{
    const double whole = a->time[cell + 1] - a->time[cell];
    const double x = (time - a->time[cell]) / whole;
    const double v0 = whole / pace(a, cell, 0);
    const double v1 = whole / pace(a, cell, 1);
    const double a0 = 0.5 * whole * whole * slope_of(a->square + cell, 0);
    const double a1 = 0.5 * whole * whole * slope_of(a->square + cell, 1);
    const double c3 = 10 - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1;
    const double c4 = -15 + 8 * v0 + 7 * v1 + 1.5 * a0 - a1;
    const double c5 = 6 - 3 * v0 - 3 * v1 - 0.5 * a0 + 0.5 * a1;
    const double u = x * (v0 + x * (0.5 * a0 + x * (c3 + x * (c4 + x * c5))));

    return (double)cell + maths_clamp(u, 0, 1);
}

/* Place along the path at an old knot, by the half knots. */
static double place_at(const struct warp *a, double u)
{
    const double *place_mm = &a->w->trail->place_mm[2 * a->w->first];
    size_t site = (size_t)(2 * u);

    if (site >= 2 * a->cells)
        site = 2 * a->cells - 1;
    return place_mm[site] + (place_mm[site + 1] - place_mm[site]) * (2 * u - (double)site);
}

static void point_at(const struct warp *a, double u, double point[3])
{
    size_t k = (size_t)u;
    double weight[4];

    if (k >= a->cells)
        k = a->cells - 1;
    trail_weights(u - (double)k, weight);
    trail_sum(a->control + k, weight, point);
}

/*
 * Places at the new half knots, and into the control points what the curve is at the new knots: control point j + 1 has
 * knot j.
 */
static void sample(const struct warp *a, struct trail *t)
{
    size_t cell = 0;

    for (size_t site = 0; site <= 2 * t->intervals; site++) {
        const double time = 0.5 * (double)site;
        double u;

        while (cell + 1 < a->cells && a->time[cell + 1] < time)
            cell++;
        u = knot_at(a, cell, time);
        t->place_mm[site] = place_at(a, u);
        if (site % 2 == 0)
            point_at(a, u, t->control[site / 2 + 1]);
    }
}

/*
 * (c_(k-1) + 4 c_k + c_(k+1)) / 6 = p_k between the ends, which are known: by elimination, pivot_k = 1 / (4 - pivot_(k-1)).
 * What has not been moved is found again, jumps of jerk included.
 */
static void points_to_control(struct trail *t, double *pivot)
{
    double(*c)[3] = t->control;
    const size_t end = t->intervals;

    for (size_t k = TRAIL_ENDS; k < end; k++) {
        const bool is_last = k + 1 == end;

        pivot[k] = 1 / (4 - (k > TRAIL_ENDS ? pivot[k - 1] : 0));
        for (int i = 0; i < 3; i++)
            c[k][i] = pivot[k] * (6 * c[k][i] - c[k - 1][i] - (is_last ? c[end][i] : 0));
    }
    for (size_t k = end - 1; k-- > TRAIL_ENDS;) {
        for (int i = 0; i < 3; i++)
            c[k][i] -= pivot[k] * c[k + 1][i];
    }
}

static void keep_ends(const struct warp *a, struct trail *t)
{
    for (size_t k = 0; k < TRAIL_ENDS; k++) {
        vector_copy(a->control[k], t->control[k]);
        vector_copy(a->control[a->cells + k], t->control[t->intervals + k]);
    }
}

static void find_feet(const struct ahead_path *path, struct trail *t)
{
    double last_mm = t->place_mm[0];
    size_t hint = ahead_path_find(path, last_mm, 0);

    for (size_t site = 1; site < 2 * t->intervals; site++) {
        const double way_mm = t->place_mm[site + 1] - t->place_mm[site];
        const double reach_mm = maths_clamp(REACH_PART * way_mm, REACH_MIN_MM, REACH_MAX_MM);
        struct ahead_foot foot;
        double x[3];

        trail_at(t, 0.5 * (double)site, x);
        ahead_path_foot(path, x, t->place_mm[site], reach_mm, hint, &foot);
        hint = foot.element;
        last_mm = maths_max(last_mm, foot.place_mm);
        t->place_mm[site] = maths_min(last_mm, t->place_mm[2 * t->intervals]);
    }
}

static bool warp_allocate(struct warp *a)
{
    a->control = calloc(a->cells + TRAIL_ENDS, sizeof *a->control);
    a->square = calloc(a->cells + TRAIL_ENDS, sizeof *a->square);
    a->time = calloc(a->cells + 1, sizeof *a->time);
    return a->control != NULL && a->square != NULL && a->time != NULL;
}

static void warp_free(struct warp *a)
{
    free(a->control);
    free(a->square);
    free(a->time);
}

static void move(struct warp *a, double (*change)[4])
{
    for (size_t k = 0; k < a->cells + TRAIL_ENDS; k++) {
        vector_copy(a->w->trail->control[a->w->first + k], a->control[k]);
        a->square[k] = 1;
    }
    for (size_t k = TRAIL_ENDS; k < a->cells; k++) {
        for (int i = 0; i < 3; i++)
            a->control[k][i] += change[k - TRAIL_ENDS][i];
        a->square[k] += change[k - TRAIL_ENDS][3];
    }
}

/* The same knots, moved. */
static bool take_moved(const struct warp *a, struct trail *t)
{
    if (!trail_allocate(t, a->cells))
        return false;
    memcpy(t->control, a->control, (a->cells + TRAIL_ENDS) * sizeof *t->control);
    memcpy(t->place_mm, &a->w->trail->place_mm[2 * a->w->first],
           (2 * a->cells + 1) * sizeof *t->place_mm);
    return true;
}

static bool take_warped(struct warp *a, struct trail *t)
{
    double *pivot;

    if (!trail_allocate(t, end_on_a_knot(a)))
        return false;
    pivot = calloc(t->intervals, sizeof *pivot);
    if (pivot == NULL) {
        trail_free(t);
        return false;
    }
    sample(a, t);
    keep_ends(a, t);
    points_to_control(t, pivot);
    free(pivot);
    return true;
}

bool warp_window(const struct problem_window *w, size_t cells, double (*change)[4], bool timed,
                 struct trail *result)
{
    struct warp a = {.w = w, .cells = cells};
    bool done = warp_allocate(&a);

    if (done) {
        move(&a, change);
        done = timed ? take_warped(&a, result) : take_moved(&a, result);
    }
    if (done)
        find_feet(w->path, result);
    warp_free(&a);
    return done;
}
