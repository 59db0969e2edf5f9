#include "ahead/warp.h"

#include "convex/band.h"
#include "convex/vector.h"

#include <stdlib.h>
#include <string.h>

/* The rate's square is not below this, whatever overshoots. */
#define SQUARE_MIN 0.04

/*
 * How far along the path a closest point is looked for: so many times the way of a knot, within
 * bounds.
 */
#define REACH_PART   2.0
#define REACH_MIN_MM 0.06
#define REACH_MAX_MM 0.5

struct warp {
    const struct window *w;
    size_t cells;
    unsigned modes;
    size_t ends;          /* control points that stay */
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
    knots = (size_t)takt_maths_ceil(plain - 1e-9);
    if (knots < a->ends + 1)
        knots = a->ends + 1;
    a->stretch = 1;
    stretched = whole_time(a);
    a->stretch = ((double)knots - plain) / (stretched - plain);
    (void)whole_time(a);
    return knots;
}

/*
 * The old knot u at a time within an interval: the polynomial of degree 5 with u, du/dt = 1 / pace
 * and d2u/dt2 of both ends; d2u/dt2 by the slope of y alone, the stretch is too slow to matter:
 * u' = sqrt(y), u" = y' / 2.
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
    const size_t points = TRAIL_ENDS + 1 + 2 * (size_t)a->modes;
    size_t k = (size_t)u;
    double weight[TRAIL_ENDS + 1 + 2 * MODES_MAX];

    if (k >= a->cells)
        k = a->cells - 1;
    trail_curve_weights(a->modes, u - (double)k, weight);
    for (int i = 0; i < 3; i++) {
        point[i] = weight[0] * a->control[k][i];
        for (size_t n = 1; n < points; n++)
            point[i] += weight[n] * a->control[k + n][i];
    }
}

/*
 * Places at the new half knots, and into the control points what the curve is at the new knots:
 * control point j + 1 + modes is in the middle of those that make knot j.
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
            point_at(a, u, t->control[site / 2 + 1 + a->modes]);
    }
}

/* The equations for the control points between the ends. */
struct knots {
    size_t count;
    double *band;
    double *right;
};

/*
 * d! times the weights of control points at a knot of a curve of degree d = 3 + 2 modes, from the
 * middle one on; and d!
 */
static const double knot_weight[MODES_MAX + 1][2 + MODES_MAX] = {
    {4, 1}, {66, 26, 1}, {2416, 1191, 120, 1}};
static const double knot_sum[MODES_MAX + 1] = {6, 120, 5040};

/*
 * The right side of control point k, without what is before it, by elimination or known, and what
 * is known behind it.
 */
static double eliminated(const struct warp *a, const struct trail *t, const struct knots *of,
                         size_t k, int axis)
{
    const double *weight = knot_weight[a->modes];
    const size_t width = 2 + (size_t)a->modes;
    double sum = knot_sum[a->modes] * t->control[k + a->ends][axis];

    for (size_t n = 1; n < width; n++)
        sum -= k >= n ? of->band[(k - n) * width + n] * of->right[k - n]
                      : weight[n] * t->control[k + a->ends - n][axis];
    for (size_t n = 1; n < width; n++)
        sum -= k + n >= of->count ? weight[n] * t->control[k + a->ends + n][axis] : 0;
    return sum;
}

/*
 * sum_n weight_n c_(k+n) = p_k between the ends, which are known. What has not been moved is found
 * again, jumps of the highest derivative included.
 */
static void points_to_control(const struct warp *a, struct trail *t, const struct knots *of)
{
    const size_t width = 2 + (size_t)a->modes;

    for (size_t k = 0; k < of->count; k++)
        memcpy(of->band + k * width, knot_weight[a->modes], width * sizeof *of->band);
    band_factor(of->band, width, of->count);
    for (int i = 0; i < 3; i++) {
        for (size_t k = 0; k < of->count; k++)
            of->right[k] = eliminated(a, t, of, k, i);
        band_back(of->band, width, of->count, of->right);
        for (size_t k = 0; k < of->count; k++)
            t->control[k + a->ends][i] = of->right[k];
    }
}

static void keep_ends(const struct warp *a, struct trail *t)
{
    for (size_t k = 0; k < a->ends; k++) {
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
        struct ahead_closest closest;
        double x[3];

        trail_at(t, t->tool, 0.5 * (double)site, x);
        ahead_path_closest(path, x, t->place_mm[site], reach_mm, hint, &closest);
        hint = closest.element;
        last_mm = maths_max(last_mm, closest.place_mm);
        t->place_mm[site] = maths_min(last_mm, t->place_mm[2 * t->intervals]);
    }
}

static bool warp_allocate(struct warp *a)
{
    a->control = calloc(a->cells + a->ends, sizeof *a->control);
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
    for (size_t k = 0; k < a->cells + a->ends; k++)
        vector_copy(a->w->trail->control[a->w->first + k], a->control[k]);
    for (size_t k = 0; k < a->cells + TRAIL_ENDS; k++)
        a->square[k] = 1;
    for (size_t k = a->ends; k < a->cells; k++) {
        for (int i = 0; i < 3; i++)
            a->control[k][i] += change[k - a->ends][i];
        a->square[k - a->modes] += change[k - a->ends][3];
    }
}

/* The same knots, moved. */
static bool take_moved(const struct warp *a, struct trail *t)
{
    if (!trail_allocate(t, a->cells, a->modes))
        return false;
    memcpy(t->control, a->control, (a->cells + a->ends) * sizeof *t->control);
    memcpy(t->place_mm, &a->w->trail->place_mm[2 * a->w->first],
           (2 * a->cells + 1) * sizeof *t->place_mm);
    return true;
}

static bool take_warped(struct warp *a, struct trail *t)
{
    struct knots of;
    bool done;

    if (!trail_allocate(t, end_on_a_knot(a), a->modes))
        return false;
    of.count = t->intervals - a->ends;
    of.band = calloc(of.count * (2 + (size_t)a->modes), sizeof *of.band);
    of.right = calloc(of.count, sizeof *of.right);
    done = of.band != NULL && of.right != NULL;
    if (done) {
        sample(a, t);
        keep_ends(a, t);
        points_to_control(a, t, &of);
    } else {
        trail_free(t);
    }
    free(of.band);
    free(of.right);
    return done;
}

bool warp_window(const struct window *w, size_t cells, double (*change)[4], bool timed,
                 struct trail *result)
{
    struct warp a = {
        .w = w, .cells = cells, .modes = w->trail->modes, .ends = trail_ends(w->trail->modes)};
    bool done = warp_allocate(&a);

    if (done) {
        move(&a, change);
        done = timed ? take_warped(&a, result) : take_moved(&a, result);
    }
    if (done) {
        trail_continue(result, w->trail, w->first, cells);
        trail_follow(result, &w->limits->modes);
        find_feet(w->path, result);
    }
    warp_free(&a);
    return done;
}
