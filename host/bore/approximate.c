/*
 * As long pieces as the tolerance allows, one after the other. How far a piece is off is measured:
 * the curve's points at SAMPLES places of it against the piece. Between two samples the deviation,
 * a smooth bump or two over the piece, can be larger by a few parts in 1000; SHARE leaves room for
 * that.
 *
 * A pair of arcs that begins in A along t and ends in B along u (biarc): with equal lengths d of
 * the tangents from the ends to the tangent at the junction J,
 *
 *     v = B - A,   2 d^2 (1 - t . u) + 2 d v . (t + u) - v . v = 0,   J half way from A + d t to B - d u
 */
#include "bore/approximate.h"

#include "base/maths.h"

#include <string.h>

#define SAMPLES 32
#define SHARE   0.98

/* Heading by which one piece turns at most. */
#define TURN_MAX_RAD 1.5

/* Halvings of the last doubling, when a piece is made as long as it may be. */
#define REFINE 6

/* Pieces from one place to another: fills at most two, returns how many. */
typedef unsigned (*maker)(const struct bore_curve *c, double from, double to,
                          struct bore_piece piece[2]);

static unsigned make_line(const struct bore_curve *c, double from, double to,
                          struct bore_piece piece[2])
{
    double direction[2];

    (void)from;
    piece[0] = (struct bore_piece){.kind = BORE_LINE};
    c->at(c->context, to, piece[0].to_mm, direction);
    return 1;
}

static double dot(const double a[2], const double b[2])
{
    return a[0] * b[0] + a[1] * b[1];
}

/* Length of the tangents of the pair of arcs. */
static double tangent_length(const double v[2], const double t[2], const double u[2])
{
    double sum[2] = {t[0] + u[0], t[1] + u[1]};
    double a = 2 * (1 - dot(t, u));
    double b = dot(v, sum);

    /* a d^2 + 2 b d - v.v = 0, the positive root, also when a is 0 */
    return dot(v, v) / (b + maths_sqrt(b * b + a * dot(v, v)));
}

/*
 * Centre of the arc from a, along t, to b: a + n (b - a)^2 / (2 (b - a) . n), n the normal to the
 * left.
 */
static void arc_centre(const double a[2], const double t[2], const double b[2], double centre[2])
{
    double v[2] = {b[0] - a[0], b[1] - a[1]};
    double n[2] = {-t[1], t[0]};
    double radius = dot(v, v) / (2 * dot(v, n));

    centre[0] = a[0] + radius * n[0];
    centre[1] = a[1] + radius * n[1];
}

static unsigned make_arcs(const struct bore_curve *c, double from, double to,
                          struct bore_piece piece[2])
{
    double a[2], b[2], t[2], u[2], junction[2];

    c->at(c->context, from, a, t);
    c->at(c->context, to, b, u);
    double v[2] = {b[0] - a[0], b[1] - a[1]};
    double back[2] = {-u[0], -u[1]};
    double d = tangent_length(v, t, u);

    for (unsigned i = 0; i < 2; i++)
        junction[i] = 0.5 * (a[i] + d * t[i] + b[i] - d * u[i]);
    for (unsigned i = 0; i < 2; i++) {
        piece[i] = (struct bore_piece){.kind = BORE_ARC};
        memcpy(piece[i].to_mm, i == 0 ? junction : b, sizeof piece[i].to_mm);
    }
    arc_centre(a, t, junction, piece[0].centre_mm);
    arc_centre(b, back, junction, piece[1].centre_mm);
    return 2;
}

static double distance(const double a[2], const double b[2])
{
    double v[2] = {a[0] - b[0], a[1] - b[1]};

    return maths_sqrt(dot(v, v));
}

/*
 * For a point beside the piece that begins at start: an arc counts as its circle, a line as without
 * ends.
 */
static double off_piece(const double start[2], const struct bore_piece *piece,
                        const double point[2])
{
    double way[2] = {piece->to_mm[0] - start[0], piece->to_mm[1] - start[1]};
    double off[2] = {point[0] - start[0], point[1] - start[1]};

    if (piece->kind == BORE_ARC)
        return maths_abs(distance(point, piece->centre_mm) - distance(start, piece->centre_mm));
    return maths_abs(way[0] * off[1] - way[1] * off[0]) / maths_sqrt(dot(way, way));
}

/*
 * Is the point beside the first of two arcs? The junction is the place where both have the same
 * direction.
 */
static bool is_before(const double junction[2], const struct bore_piece *first,
                      const double point[2])
{
    double radius[2] = {junction[0] - first->centre_mm[0], junction[1] - first->centre_mm[1]};
    double off[2] = {point[0] - junction[0], point[1] - junction[1]};

    /* before the junction against the direction there, which is to the left of the radius */
    return off[1] * radius[0] - off[0] * radius[1] < 0;
}

static double deviation(const struct bore_curve *c, double from, double to, maker make,
                        struct bore_piece piece[2], unsigned *pieces)
{
    double start[2], direction[2], most = 0;

    *pieces = make(c, from, to, piece);
    c->at(c->context, from, start, direction);
    for (unsigned i = 1; i < SAMPLES; i++) {
        double point[2];

        c->at(c->context, from + (to - from) * i / SAMPLES, point, direction);
        if (*pieces == 1 || is_before(piece[0].to_mm, &piece[0], point))
            most = maths_max(most, off_piece(start, &piece[0], point));
        else
            most = maths_max(most, off_piece(piece[0].to_mm, &piece[1], point));
    }
    return most;
}

/* The farthest place that pieces from from may reach; last: how far the ones before went. */
static double reach(const struct bore_curve *c, double from, double to, double last, maker make,
                    double tolerance_mm)
{
    double good = 0, step = maths_min(last * 1.5, maths_min(TURN_MAX_RAD, to - from));
    double bad = 0;
    struct bore_piece piece[2];
    unsigned pieces;

    while (deviation(c, from, from + step, make, piece, &pieces) > SHARE * tolerance_mm) {
        bad = step;
        step *= 0.5;
    }
    good = step;
    for (unsigned i = 0; i < REFINE && bad > 0; i++) {
        step = 0.5 * (good + bad);
        if (deviation(c, from, from + step, make, piece, &pieces) > SHARE * tolerance_mm)
            bad = step;
        else
            good = step;
    }
    return from + good >= to ? to : from + good;
}

static void approximate(struct bore_path *p, const struct bore_curve *c, double from, double to,
                        maker make, double tolerance_mm)
{
    double last = TURN_MAX_RAD;

    while (from < to && !p->failed) {
        double next = reach(c, from, to, last, make, tolerance_mm);
        struct bore_piece piece[2];
        unsigned pieces = make(c, from, next, piece);

        for (unsigned i = 0; i < pieces; i++)
            bore_path_add(p, &piece[i]);
        last = next - from;
        from = next;
    }
}

void bore_approximate_arcs(struct bore_path *p, const struct bore_curve *c, double from, double to,
                           double tolerance_mm)
{
    approximate(p, c, from, to, make_arcs, tolerance_mm);
}

void bore_approximate_lines(struct bore_path *p, const struct bore_curve *c, double from, double to,
                            double tolerance_mm)
{
    approximate(p, c, from, to, make_line, tolerance_mm);
}
