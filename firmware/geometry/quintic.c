/*
 * A polynomial of fifth degree in its arc length that has place, direction and curvature of a curve
 * in a plane at both ends. With u = s / L, D = end - start, T = (cos heading, sin heading),
 * K = curvature (-sin heading, cos heading):
 *
 *     x(s) = start + c1 u + c2 u^2 + c3 u^3 + c4 u^4 + c5 u^5,     c1 = D - c2 - c3 - c4 - c5
 *     c2 = L^2 K0 / 2
 *     c3 =  10 D - L (6 T0 + 4 T1) - L^2 (3 K0 - K1) / 2
 *     c4 = -15 D + L (8 T0 + 7 T1) + L^2 (3 K0 - 2 K1) / 2
 *     c5 =   6 D - L (3 T0 + 3 T1) - L^2 (K0 - K1) / 2
 *
 * It leaves the curve by some L^6, and its s the curve's arc length by as little: who makes pieces
 * of a curve (nurbs.c) looks that both are small. Pieces that follow each other have their ends in
 * common, so tangent and curvature are continuous.
 *
 * Bounds. A polynomial lies within its Bernstein coefficients. Those of x', x'' and x''' are
 * differences of those of x; those of the products x' . x'' and x' x x''' follow from them. All
 * hold for every s, not for samples.
 */
#include "geometry/quintic.h"

#include "base/assert.h"
#include "base/maths.h"

#include <string.h>

#define DEGREE 5U

/* A straight piece is curved by rounding: curvature (1/mm) below which nobody feels it. */
#define STRAIGHT_1_MM 1e-9

/* Steps of halving until a place is exact. */
#define HALVINGS 50

static unsigned axis_of(const struct curve *c, unsigned i)
{
    TAKT_ASSERT(i < 2);
    return i == 0 ? c->quintic.first : c->quintic.second;
}

/* c1 ... c5 of an axis of the plane. */
static void coefficients(const struct curve *c, unsigned i, double k[DEGREE])
{
    const unsigned axis = axis_of(c, i);

    k[0] = c->end.at[axis] - c->start.at[axis];
    for (unsigned n = 1; n < DEGREE; n++) {
        k[n] = c->quintic.coefficient_mm[i][n - 1];
        k[0] -= k[n];
    }
}

static void set_axis(struct curve *c, unsigned i, const double tangent[2],
                     const double curvature[2])
{
    const unsigned axis = axis_of(c, i);
    const double d = c->end.at[axis] - c->start.at[axis];
    const double l = c->length_mm;
    const double square = 0.5 * l * l;
    double *k = c->quintic.coefficient_mm[i];

    k[0] = square * curvature[0];
    k[1] = 10.0 * d - l * (6.0 * tangent[0] + 4.0 * tangent[1]) -
           square * (3.0 * curvature[0] - curvature[1]);
    k[2] = -15.0 * d + l * (8.0 * tangent[0] + 7.0 * tangent[1]) +
           square * (3.0 * curvature[0] - 2.0 * curvature[1]);
    k[3] = 6.0 * d - l * (3.0 * tangent[0] + 3.0 * tangent[1]) -
           square * (curvature[0] - curvature[1]);
}

bool takt_curve_set_quintic(struct curve *c, const struct point *start, const struct point *end,
                            enum plane plane, const struct curve_course *course)
{
    double sine[2];
    double cosine[2];
    enum axis first;
    enum axis second;

    takt_plane_axes(plane, &first, &second);
    memset(c, 0, sizeof(*c));
    c->kind = CURVE_QUINTIC;
    c->start = *start;
    c->end = *end;
    c->length_mm = course->length_mm;
    c->quintic.first = (unsigned char)first;
    c->quintic.second = (unsigned char)second;
    for (unsigned i = 0; i < 2; i++) {
        takt_maths_sincos(course->heading_rad[i], &sine[i], &cosine[i]);
    }
    const double *k = course->curvature_1_mm;

    set_axis(c, 0, cosine, (double[2]){-k[0] * sine[0], -k[1] * sine[1]});
    set_axis(c, 1, sine, (double[2]){k[0] * cosine[0], k[1] * cosine[1]});
    return c->length_mm >= CURVE_LENGTH_MIN_MM;
}

void takt_quintic_point(const struct curve *c, double s_mm, struct point *p)
{
    const double u = s_mm / c->length_mm;

    *p = c->start;
    for (unsigned i = 0; i < 2; i++) {
        double k[DEGREE];

        coefficients(c, i, k);
        p->at[axis_of(c, i)] += ((((k[4] * u + k[3]) * u + k[2]) * u + k[1]) * u + k[0]) * u;
    }
}

void takt_quintic_tangent(const struct curve *c, double s_mm, struct point *t)
{
    const double u = s_mm / c->length_mm;

    memset(t, 0, sizeof(*t));
    for (unsigned i = 0; i < 2; i++) {
        double k[DEGREE];

        coefficients(c, i, k);
        t->at[axis_of(c, i)] =
            ((((5.0 * k[4] * u + 4.0 * k[3]) * u + 3.0 * k[2]) * u + 2.0 * k[1]) * u + k[0]) /
            c->length_mm;
    }
}

void takt_quintic_curvature(const struct curve *c, double s_mm, struct point *curvature)
{
    const double u = s_mm / c->length_mm;

    memset(curvature, 0, sizeof(*curvature));
    for (unsigned i = 0; i < 2; i++) {
        double k[DEGREE];

        coefficients(c, i, k);
        curvature->at[axis_of(c, i)] =
            (((20.0 * k[4] * u + 12.0 * k[3]) * u + 6.0 * k[2]) * u + 2.0 * k[1]) /
            (c->length_mm * c->length_mm);
    }
}

static double binomial(unsigned n, unsigned k)
{
    double value = 1.0;

    TAKT_ASSERT(k <= n);
    for (unsigned i = 0; i < k; i++) {
        value = value * (double)(n - i) / (double)(i + 1);
    }
    return value;
}

/*
 * Bernstein coefficients of the derivatives by s: b_j = sum over i <= j of C(j, i) / C(5, i) c_i,
 * and their differences.
 */
struct hull {
    double first[DEGREE][2], second[DEGREE - 1][2], third[DEGREE - 2][2];
};

static void set_hull(const struct curve *c, struct hull *h)
{
    const double per_mm = 1.0 / c->length_mm;

    for (unsigned i = 0; i < 2; i++) {
        double k[DEGREE];
        double b[DEGREE + 1];

        coefficients(c, i, k);
        for (unsigned j = 0; j <= DEGREE; j++) {
            b[j] = 0.0;
            for (unsigned n = 1; n <= j; n++) {
                b[j] += binomial(j, n) / binomial(DEGREE, n) * k[n - 1];
            }
        }
        for (unsigned j = 0; j < DEGREE; j++) {
            h->first[j][i] = 5.0 * (b[j + 1] - b[j]) * per_mm;
        }
        for (unsigned j = 0; j < DEGREE - 1; j++) {
            h->second[j][i] = 4.0 * (h->first[j + 1][i] - h->first[j][i]) * per_mm;
        }
        for (unsigned j = 0; j < DEGREE - 2; j++) {
            h->third[j][i] = 3.0 * (h->second[j + 1][i] - h->second[j][i]) * per_mm;
        }
    }
}

/* The longest of some vectors. */
static double longest(double vector[][2], unsigned count)
{
    double square = 0.0;

    for (unsigned i = 0; i < count; i++) {
        square = maths_max(square, vector[i][0] * vector[i][0] + vector[i][1] * vector[i][1]);
    }
    return maths_sqrt(square);
}

/*
 * The largest |a . b|, or |a x b|, of polynomials of degrees n and m by their Bernstein
 * coefficients: those of the product are sum over i + j = k of C(n, i) C(m, j) / C(n + m, k) a_i
 * b_j.
 */
static double product_max(double a[][2], unsigned n, double b[][2], unsigned m, bool cross)
{
    double largest = 0.0;

    for (unsigned k = 0; k <= n + m; k++) {
        double sum = 0.0;

        for (unsigned i = k > m ? k - m : 0; i <= n && i <= k; i++) {
            const double *p = a[i];
            const double *q = b[k - i];
            const double part = cross ? p[0] * q[1] - p[1] * q[0] : p[0] * q[0] + p[1] * q[1];

            sum += binomial(n, i) * binomial(m, k - i) / binomial(n + m, k) * part;
        }
        largest = maths_max(largest, maths_abs(sum));
    }
    return largest;
}

/*
 * Along and across count by the direction, which x' has but for its length q, nearly 1: both are
 * divided by the least q. As parts of the whole they are never above it: so a piece that is hardly
 * curved, or whose curvature only changes, has sane ratios.
 */
void takt_quintic_bound(const struct curve *c, struct curve_bounds *b)
{
    struct hull h;

    memset(b, 0, sizeof(*b));
    set_hull(c, &h);
    const double first = longest(h.first, DEGREE);
    const double least = maths_max(0.5, 2.0 - first);
    const double second = maths_max(STRAIGHT_1_MM, longest(h.second, DEGREE - 1));
    const double third = maths_max(STRAIGHT_1_MM * STRAIGHT_1_MM, longest(h.third, DEGREE - 2));

    for (unsigned i = 0; i < 2; i++) {
        b->first[axis_of(c, i)] = first;
        b->second[axis_of(c, i)] = second;
        b->third[axis_of(c, i)] = third;
    }
    b->radius_min_mm = 1.0 / second;
    b->second_along =
        maths_min(second, product_max(h.first, DEGREE - 1, h.second, DEGREE - 2, false) / least);
    b->third_across =
        maths_min(third, product_max(h.first, DEGREE - 1, h.third, DEGREE - 3, true) / least);
}

/*
 * A piece turns by less than half a turn, so a component of its direction changes its sign once at
 * most.
 */
bool takt_quintic_extreme(const struct curve *c, unsigned in_plane, double *s_mm)
{
    const unsigned axis = axis_of(c, in_plane);
    double low = 0.0;
    double high = c->length_mm;
    struct point t;

    takt_quintic_tangent(c, low, &t);
    const bool rises = t.at[axis] > 0.0;

    takt_quintic_tangent(c, high, &t);
    if ((t.at[axis] > 0.0) == rises) {
        return false;
    }
    for (unsigned i = 0; i < HALVINGS; i++) {
        const double middle = 0.5 * (low + high);

        takt_quintic_tangent(c, middle, &t);
        if ((t.at[axis] > 0.0) == rises) {
            low = middle;
        } else {
            high = middle;
        }
    }
    *s_mm = low;
    return true;
}
