#include "ahead/guess.h"

#include "convex/vector.h"

#include <stdlib.h>

/* Part of the axes' acceleration that the guess uses. */
#define GUESS_PART 0.7

/* Elements are cut to pieces of about this length, and into so many at most. */
#define PIECE_MM   0.25
#define PIECES_MAX 400

struct guess {
    const struct ahead_path *path;
    const struct ahead_limits *limits;
    size_t count;      /* nodes */
    double *place_mm;  /* of each node */
    double *square;    /* feed squared there, mm2/s2 */
    double *rate;      /* acceleration from this node to the next, mm/s2 */
    double *jerk;      /* likewise, mm/s3 */
    size_t *element;   /* that begins at, or holds, the node */
    double *reached_s; /* when the node is passed */
};

static size_t pieces_of(const struct ahead_element *e)
{
    return (size_t)maths_clamp(takt_maths_ceil(e->curve.length_mm / PIECE_MM), 1, PIECES_MAX);
}

static void guess_free(struct guess *g)
{
    free(g->place_mm);
    free(g->square);
    free(g->rate);
    free(g->jerk);
    free(g->element);
    free(g->reached_s);
}

static bool guess_allocate(struct guess *g)
{
    g->count = 1;
    for (size_t k = 0; k < g->path->count; k++)
        g->count += pieces_of(&g->path->element[k]);
    g->place_mm = calloc(g->count, sizeof *g->place_mm);
    g->square = calloc(g->count, sizeof *g->square);
    g->rate = calloc(g->count, sizeof *g->rate);
    g->jerk = calloc(g->count, sizeof *g->jerk);
    g->element = calloc(g->count, sizeof *g->element);
    g->reached_s = calloc(g->count, sizeof *g->reached_s);
    return g->place_mm != NULL && g->square != NULL && g->rate != NULL && g->jerk != NULL &&
           g->element != NULL && g->reached_s != NULL;
}

/* How much of a limit one unit along the direction leaves: min_i limit_i / |t_i|. */
static double along(const double limit[3], const double t[3])
{
    double least = MATHS_INFINITY;

    for (int i = 0; i < 3; i++) {
        if (maths_abs(t[i]) > 1e-12)
            least = maths_min(least, limit[i] / maths_abs(t[i]));
    }
    return least;
}

/* Curvature |d2x/ds2|, 1/mm. */
static double curvature_of(const struct curve *c)
{
    struct curve_bounds b;

    if (c->kind == CURVE_LINE)
        return 0;
    takt_curve_bound(c, &b);
    return b.radius_min_mm > 0 ? 1 / b.radius_min_mm : 0;
}

static double smallest(const double v[3])
{
    return maths_min(v[0], maths_min(v[1], v[2]));
}

/* v <= feed, V along the tangent, sqrt(A / k) and cbrt(J / k^2) on a curve of curvature k. */
static double feed_at(const struct guess *g, const struct ahead_element *e, const double t[3])
{
    const double k = curvature_of(&e->curve);
    double feed = maths_min(e->feed_mm_s, along(g->limits->velocity_mm_s, t));

    if (k > 0) {
        feed = maths_min(feed, maths_sqrt(smallest(g->limits->acceleration_mm_s2) / k));
        feed = maths_min(feed, takt_maths_cbrt(smallest(g->limits->jerk_mm_s3) / (k * k)));
    }
    return feed;
}

/*
 * A corner with the change of direction d, m its largest component, is passed within P = |d| v
 * T / 12 by a triangle of acceleration, T = 2 sqrt(v m / J), and within P = |d| v T / 8 by an even
 * one, T = v m / A: the slower of
 *
 *     v = (6 P sqrt(J / m) / |d|)^(2/3),    v = sqrt(8 P A / (m |d|))
 *
 * so that no higher limit and no larger tolerance makes it slower.
 */
static double corner_feed(const struct guess *g, double tolerance_mm, const double from[3],
                          const double to[3])
{
    const double a = smallest(g->limits->acceleration_mm_s2);
    const double j = smallest(g->limits->jerk_mm_s3);
    double d[3];
    double m;
    double length;
    double root;

    vector_from_to(from, to, d);
    m = vector_largest(d);
    if (m < 1e-9)
        return MATHS_INFINITY;
    length = vector_length(d);
    root = takt_maths_cbrt(6 * tolerance_mm * maths_sqrt(j / m) / length);
    return maths_min(root * root, maths_sqrt(8 * tolerance_mm * a / (m * length)));
}

static void set_element(struct guess *g, size_t k, size_t *node, double previous[3])
{
    const struct ahead_element *e = &g->path->element[k];
    const size_t pieces = pieces_of(e);
    double p[3];
    double t[3];

    for (size_t i = 0; i < pieces; i++, (*node)++) {
        double feed;

        g->place_mm[*node] = e->start_mm + e->curve.length_mm * (double)i / (double)pieces;
        g->element[*node] = k;
        ahead_path_at(g->path, k, g->place_mm[*node], p, t);
        feed = feed_at(g, e, t);
        if (i == 0 && k > 0)
            feed = maths_min(feed, corner_feed(g, e->tolerance_mm, previous, t));
        g->square[*node] = feed * feed;
        g->rate[*node] = GUESS_PART * along(g->limits->acceleration_mm_s2, t);
        g->jerk[*node] = GUESS_PART * along(g->limits->jerk_mm_s3, t);
    }
    ahead_path_at(g->path, k, e->start_mm + e->curve.length_mm, p, previous);
}

static void set_nodes(struct guess *g)
{
    double previous[3] = {0, 0, 0};
    size_t node = 0;

    for (size_t k = 0; k < g->path->count; k++)
        set_element(g, k, &node, previous);
    g->place_mm[node] = ahead_path_length(g->path);
    g->element[node] = g->path->count - 1;
    g->square[node] = 0;
    g->square[0] = 0;
}

/*
 * The feed squared at the end of a piece, from that at its begin: v^2 + 2 a ds by an even
 * acceleration; and by that of a ramp from rest whose jerk is even, a = sqrt(J v) / 2, so that
 * d(v^(3/2)) = 3/4 sqrt(J) ds.
 */
static double ramp(const struct guess *g, size_t k, double square)
{
    const double ds = g->place_mm[k + 1] - g->place_mm[k];
    const double v = maths_sqrt(square);
    const double root = takt_maths_cbrt(v * maths_sqrt(v) + 0.75 * maths_sqrt(g->jerk[k]) * ds);

    return maths_min(square + 2 * g->rate[k] * ds, root * root * root * root);
}

/* Backwards and then forwards. */
static void limit_ramps(struct guess *g)
{
    for (size_t k = g->count - 1; k > 0; k--)
        g->square[k - 1] = maths_min(g->square[k - 1], ramp(g, k - 1, g->square[k]));
    for (size_t k = 0; k + 1 < g->count; k++)
        g->square[k + 1] = maths_min(g->square[k + 1], ramp(g, k, g->square[k]));
}

/* A piece between two rests is driven as if its middle were passed at the feed its ramps allow. */
static double piece_time(const struct guess *g, size_t k)
{
    const double ds = g->place_mm[k + 1] - g->place_mm[k];
    const double sum = maths_sqrt(g->square[k]) + maths_sqrt(g->square[k + 1]);

    if (sum > 0)
        return 2 * ds / sum;
    return 2 * maths_sqrt(ds / g->rate[k]);
}

static void set_times(struct guess *g)
{
    for (size_t k = 0; k + 1 < g->count; k++)
        g->reached_s[k + 1] = g->reached_s[k] + piece_time(g, k);
}

/* Place at the time reached_s[k] + t, with even acceleration between the nodes. */
static double place_in_piece(const struct guess *g, size_t k, double t)
{
    const double v0 = maths_sqrt(g->square[k]);
    const double v1 = maths_sqrt(g->square[k + 1]);
    const double whole = g->reached_s[k + 1] - g->reached_s[k];
    const double ds = g->place_mm[k + 1] - g->place_mm[k];

    if (!(v0 + v1 > 0))
        return g->place_mm[k] + ds * t / whole;
    return g->place_mm[k] + maths_clamp(v0 * t + 0.5 * (v1 - v0) / whole * t * t, 0, ds);
}

/* Knots 1 and the last but one are at rest as well: the ends' three control points are equal. */
static void sample(const struct guess *g, struct trail *t)
{
    const double step_s = g->limits->step_s;
    const double whole_s = g->reached_s[g->count - 1];
    size_t k = 0;

    for (size_t site = 0; site <= 2 * t->intervals; site++) {
        const double s = maths_clamp((0.5 * (double)site - 1) * step_s, 0, whole_s);

        while (k + 2 < g->count && g->reached_s[k + 1] < s)
            k++;
        t->place_mm[site] = place_in_piece(g, k, s - g->reached_s[k]);
        if (site % 2 == 0) {
            double tangent[3];
            const size_t e = ahead_path_find(g->path, t->place_mm[site], g->element[k]);

            ahead_path_at(g->path, e, t->place_mm[site], t->control[site / 2 + 1], tangent);
        }
    }
    vector_copy(t->control[1], t->control[0]);
    vector_copy(t->control[t->intervals + 1], t->control[t->intervals + 2]);
}

bool guess_trail(const struct ahead_path *path, const struct ahead_limits *limits,
                 struct trail *trail)
{
    struct guess g = {.path = path, .limits = limits};
    bool done = guess_allocate(&g);

    if (done) {
        set_nodes(&g);
        limit_ramps(&g);
        set_times(&g);
        done = trail_allocate(
            trail, (size_t)takt_maths_ceil(g.reached_s[g.count - 1] / limits->step_s) + 4, 0);
    }
    if (done)
        sample(&g, trail);
    guess_free(&g);
    return done;
}
