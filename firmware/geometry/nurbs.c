/*
 * A NURBS curve of degree d over the span of its knots t_l <= u <= t_l+1 is a rational polynomial:
 * in homogeneous coordinates (w x, w y, w) one whose blossom b(u_1, ..., u_d), which is linear in
 * each of its arguments and does not mind their order, has the control points as values at
 * successive knots. Values at u0 (d - j times) and u1 (j times) are the Bezier points of the curve
 * between u0 and u1:
 *
 *     step r: point_i = (1 - a) point_i-1 + a point_i,   a = (u_r - t_i) / (t_i+d+1-r - t_i)
 *
 * A piece takes place, direction and curvature from both ends and its length from Gauss-Legendre
 * quadrature, and is halved until three places of it are as near to the curve as is asked for and
 * its tangent there has length 1. Its error grows like L^6 and is largest in the middle; halving
 * makes it 64 times less.
 *
 * Rejected: arcs (curvature steps, and 1e-9 mm takes thousands); following the parameter (feed goes
 * up and down with the spacing of the control points); finding the parameter of a length while
 * moving (iterations in the control cycle).
 */
#include "geometry/nurbs.h"

#include "base/assert.h"
#include "base/maths.h"

#include <string.h>

/*
 * A span is halved so often at most: a curve that is not smooth even then has no direction there.
 */
#define HALVINGS_MAX 40

/*
 * The tangent may be so much longer or shorter than 1: on the exact path, and within a tolerance, a
 * tenth of what the feed may be above a limit.
 */
#define UNEVEN_EXACT 1e-6
#define UNEVEN_MAX   1e-5

/* A piece turns by less than that, rad: some 30 degrees. */
#define TURN_MAX 0.5

/* What lies nearer to its chord is straight. */
#define STRAIGHT_MM 1e-10

#define NEWTON_STEPS 4

/* The Bezier points of a part of a span, and its length by its own parameter v = 0 ... 1. */
struct part {
    unsigned degree;
    double point[NURBS_ORDER_MAX][3];
};

/* Place and its derivatives by v. */
struct place {
    double at[2], first[2], second[2];
};

void takt_nurbs_open(struct nurbs *n, unsigned order)
{
    TAKT_ASSERT(order >= NURBS_ORDER_MIN && order <= NURBS_ORDER_MAX);
    memset(n, 0, sizeof(*n));
    n->order = order;
}

void takt_nurbs_add_point(struct nurbs *n, const double at_mm[2], double weight)
{
    double *p = n->point[n->points % NURBS_KEPT];

    if (n->points == 0) {
        memcpy(n->at_mm, at_mm, sizeof(n->at_mm));
    }
    p[0] = weight * at_mm[0];
    p[1] = weight * at_mm[1];
    p[2] = weight;
    n->points++;
}

/* The span that the newest knot decides begins at this one. */
static uint32_t span_of(const struct nurbs *n)
{
    TAKT_ASSERT(n->knots >= n->order);
    return n->knots - n->order;
}

static double knot_at(const struct nurbs *n, uint32_t index)
{
    return n->knot[index % NURBS_KEPT];
}

void takt_nurbs_add_knot(struct nurbs *n, double knot)
{
    n->knot[n->knots % NURBS_KEPT] = knot;
    n->knots++;
    if (n->knots < 2 * n->order - 1) {
        return;
    }
    n->at = knot_at(n, span_of(n));
    /* The curve ends with the span of its last point, whatever knots come after it. */
    n->within = span_of(n) < n->points && n->at < knot_at(n, span_of(n) + 1);
}

/* The value at u1 so often, else u0. */
static void blossom(const struct nurbs *n, const double u[2], unsigned often, double value[3])
{
    const unsigned degree = n->order - 1;
    const uint32_t first = span_of(n) - degree;
    double q[NURBS_ORDER_MAX][3];

    for (unsigned j = 0; j <= degree; j++) {
        memcpy(q[j], n->point[(first + j) % NURBS_KEPT], sizeof(q[j]));
    }
    for (unsigned r = 1; r <= degree; r++) {
        for (unsigned j = degree; j >= r; j--) {
            const double low = knot_at(n, first + j);
            const double high = knot_at(n, first + j + degree + 1 - r);
            const double a = (u[r <= often ? 1 : 0] - low) / (high - low);

            for (unsigned i = 0; i < 3; i++) {
                q[j][i] = (1.0 - a) * q[j - 1][i] + a * q[j][i];
            }
        }
    }
    memcpy(value, q[degree], sizeof(q[degree]));
}

static void cut(const struct nurbs *n, double from, double to, struct part *part)
{
    const double u[2] = {from, to};

    TAKT_ASSERT(from <= to);
    part->degree = n->order - 1;
    for (unsigned j = 0; j <= part->degree; j++) {
        blossom(n, u, j, part->point[j]);
    }
}

/*
 * By de Casteljau: the last three rows are value and differences. Of x = X / W: x' = (X' - W'
 * x) / W and so on.
 */
static void look(const struct part *part, double v, struct place *p)
{
    const double degree = (double)part->degree;
    double q[NURBS_ORDER_MAX][3];
    double first[3] = {0.0, 0.0, 0.0};
    double second[3] = {0.0, 0.0, 0.0};

    memcpy(q, part->point, sizeof(q));
    for (unsigned left = part->degree; left > 0; left--) {
        for (unsigned i = 0; i < 3; i++) {
            if (left == 2) {
                second[i] = degree * (degree - 1.0) * ((q[2][i] - q[1][i]) - (q[1][i] - q[0][i]));
            }
            if (left == 1) {
                first[i] = degree * (q[1][i] - q[0][i]);
            }
            for (unsigned j = 0; j < left; j++) {
                q[j][i] += v * (q[j + 1][i] - q[j][i]);
            }
        }
    }
    for (unsigned i = 0; i < 2; i++) {
        p->at[i] = q[0][i] / q[0][2];
        p->first[i] = (first[i] - first[2] * p->at[i]) / q[0][2];
        p->second[i] = (second[i] - 2.0 * first[2] * p->first[i] - second[2] * p->at[i]) / q[0][2];
    }
}

static double speed(const struct place *p)
{
    return maths_sqrt(p->first[0] * p->first[0] + p->first[1] * p->first[1]);
}

/* Gauss-Legendre, five points, of |x'(v)|. */
static double length_of(const struct part *part)
{
    static const double place[5] = {0.04691007703066800, 0.23076534494715845, 0.5,
                                    0.76923465505284155, 0.95308992296933200};
    static const double weight[5] = {0.11846344252809454, 0.23931433524968324, 0.28444444444444444,
                                     0.23931433524968324, 0.11846344252809454};
    double sum = 0.0;

    for (unsigned i = 0; i < 5; i++) {
        struct place p;

        look(part, place[i], &p);
        sum += weight[i] * speed(&p);
    }
    return sum;
}

/* Direction and curvature: x' x x'' / |x'|^3. False: it has none. */
static bool set_end(const struct place *p, unsigned end, struct curve_course *course)
{
    const double v = speed(p);

    TAKT_ASSERT(end < 2);
    if (!(v > 0.0)) {
        return false;
    }
    course->heading_rad[end] = takt_maths_atan2(p->first[1], p->first[0]);
    course->curvature_1_mm[end] =
        (p->first[0] * p->second[1] - p->first[1] * p->second[0]) / (v * v * v);
    return maths_is_finite(course->curvature_1_mm[end]);
}

/*
 * Do all Bezier points lie on the chord, one behind the other? Their weights only space the curve
 * on it.
 */
static bool is_straight(const struct part *part, const struct place *from, const struct place *to)
{
    const double way[2] = {to->at[0] - from->at[0], to->at[1] - from->at[1]};
    const double length = maths_sqrt(way[0] * way[0] + way[1] * way[1]);
    double last = 0.0;

    for (unsigned j = 0; j <= part->degree; j++) {
        const double x = part->point[j][0] / part->point[j][2] - from->at[0];
        const double y = part->point[j][1] / part->point[j][2] - from->at[1];
        const double along = x * way[0] + y * way[1];

        if (maths_abs(x * way[1] - y * way[0]) > STRAIGHT_MM * length ||
            along < last - STRAIGHT_MM * length ||
            maths_sqrt(x * x + y * y) > length + STRAIGHT_MM) {
            return false;
        }
        last = maths_max(last, along);
    }
    return true;
}

static void set_straight(const double from_mm[2], const double to_mm[2],
                         struct curve_course *course)
{
    const double way[2] = {to_mm[0] - from_mm[0], to_mm[1] - from_mm[1]};

    *course = (struct curve_course){.length_mm = maths_sqrt(way[0] * way[0] + way[1] * way[1])};
    course->heading_rad[0] = course->heading_rad[1] = takt_maths_atan2(way[1], way[0]);
}

/* Distance of a point from the part, near v: its foot by Newton's steps v += (x - p) p' / p'^2. */
static double distance_mm(const struct part *part, double v, const struct point *x)
{
    struct place p;

    look(part, v, &p);
    for (unsigned i = 0; i < NEWTON_STEPS; i++) {
        const double dot = (x->at[0] - p.at[0]) * p.first[0] + (x->at[1] - p.at[1]) * p.first[1];
        const double square = p.first[0] * p.first[0] + p.first[1] * p.first[1];

        v = maths_clamp(v + dot / square, 0.0, 1.0);
        look(part, v, &p);
    }
    const double off[2] = {x->at[0] - p.at[0], x->at[1] - p.at[1]};

    return maths_sqrt(off[0] * off[0] + off[1] * off[1]);
}

/* Does its quintic lie on the part, with a tangent of length 1? Numbers that are none do not. */
static bool fits(const struct part *part, const struct place *from, const struct place *to,
                 const struct curve_course *course, double error_mm)
{
    const struct point start = {{from->at[0], from->at[1]}};
    const struct point end = {{to->at[0], to->at[1]}};
    const double turn = course->heading_rad[1] - course->heading_rad[0];
    const double uneven_max = maths_min(UNEVEN_MAX, error_mm / NURBS_ERROR_MM * UNEVEN_EXACT);
    struct curve c;

    if (maths_abs(turn - MATHS_TWO_PI * takt_maths_round(turn / MATHS_TWO_PI)) > TURN_MAX ||
        !takt_curve_set_quintic(&c, &start, &end, PLANE_XY, course)) {
        return false;
    }
    for (unsigned quarter = 1; quarter < 4; quarter++) {
        const double s_mm = 0.25 * quarter * c.length_mm;
        struct point x;
        struct point t;

        takt_curve_point(&c, s_mm, &x);
        takt_curve_tangent(&c, s_mm, &t);
        const double uneven = t.at[0] * t.at[0] + t.at[1] * t.at[1] - 1.0;

        if (!(maths_abs(uneven) <= 2.0 * uneven_max &&
              distance_mm(part, 0.25 * quarter, &x) <= error_mm)) {
            return false;
        }
    }
    return true;
}

/*
 * From n->at to that parameter. False: it must be shorter. It begins where the last piece ends,
 * less than CURVE_LENGTH_MIN_MM beside the curve: parts too short for a piece are passed over.
 */
static bool make_piece(const struct nurbs *n, double to, double error_mm, struct nurbs_piece *piece)
{
    struct part part;
    struct place ends[2];

    cut(n, n->at, to, &part);
    look(&part, 0.0, &ends[0]);
    look(&part, 1.0, &ends[1]);
    memcpy(ends[0].at, n->at_mm, sizeof(ends[0].at));
    memcpy(piece->end_mm, ends[1].at, sizeof(piece->end_mm));
    piece->course.length_mm = length_of(&part);
    if (piece->course.length_mm < CURVE_LENGTH_MIN_MM || is_straight(&part, &ends[0], &ends[1])) {
        set_straight(ends[0].at, ends[1].at, &piece->course);
        return true;
    }
    return set_end(&ends[0], 0, &piece->course) && set_end(&ends[1], 1, &piece->course) &&
           fits(&part, &ends[0], &ends[1], &piece->course, error_mm);
}

/* A part without length, of equal points, is none: the next one begins where it does. */
static bool take_piece(struct nurbs *n, double to, const struct nurbs_piece *piece)
{
    n->at = to;
    n->within = to < knot_at(n, span_of(n) + 1);
    if (piece->course.length_mm < CURVE_LENGTH_MIN_MM) {
        return false;
    }
    memcpy(n->at_mm, piece->end_mm, sizeof(n->at_mm));
    return true;
}

/* From the first control point to where the curve begins. False: it begins there. */
static bool lead(const struct nurbs *n, struct nurbs_piece *piece)
{
    const double u[2] = {n->at, n->at};
    double begin[3];

    blossom(n, u, 0, begin);
    piece->end_mm[0] = begin[0] / begin[2];
    piece->end_mm[1] = begin[1] / begin[2];
    set_straight(n->at_mm, piece->end_mm, &piece->course);
    return piece->course.length_mm >= CURVE_LENGTH_MIN_MM;
}

enum nurbs_result takt_nurbs_next(struct nurbs *n, double error_mm, struct nurbs_piece *piece)
{
    TAKT_ASSERT(error_mm >= NURBS_ERROR_MM);
    if (n->within && lead(n, piece)) {
        memcpy(n->at_mm, piece->end_mm, sizeof(n->at_mm));
        return NURBS_PIECE;
    }
    while (n->within) {
        const double end = knot_at(n, span_of(n) + 1);
        double way = end - n->at;
        unsigned halvings = 0;

        while (!make_piece(n, halvings == 0 ? end : n->at + way, error_mm, piece)) {
            way *= 0.5;
            if (++halvings > HALVINGS_MAX || !(n->at + way > n->at)) {
                n->within = false;
                return NURBS_CUSP;
            }
        }
        if (take_piece(n, halvings == 0 ? end : n->at + way, piece)) {
            return NURBS_PIECE;
        }
    }
    return NURBS_NONE;
}
