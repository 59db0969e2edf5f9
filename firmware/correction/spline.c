#include "correction/spline.h"

#include "base/assert.h"

/* One row of the system: lower M_{i-1} + middle M_i + upper M_{i+1} = right. */
struct row {
    double lower, middle, upper, right;
};

/*
 * The first derivatives of two neighbouring pieces agree at their common knot (C. de Boor, A
 * Practical Guide to Splines, 1978, chapter IV):
 *
 *     h_{i-1} M_{i-1} + 2 (h_{i-1} + h_i) M_i + h_i M_{i+1} = 6 ((y_{i+1} - y_i) / h_i - (y_i - y_{i-1}) / h_{i-1})
 */
static void set_row(struct row *r, const double *knot, const double *value)
{
    const double before = knot[0] - knot[-1];
    const double after = knot[1] - knot[0];

    r->lower = before;
    r->middle = 2.0 * (before + after);
    r->upper = after;
    r->right = 6.0 * ((value[1] - value[0]) / after - (value[0] - value[-1]) / before);
}

/* Not a knot at the first: M_0 = (1 + q) M_1 - q M_2, q = h_0 / h_1; put into the row of M_1. */
static void close_first(struct row *r)
{
    const double q = r->lower / r->upper;

    r->middle += r->lower * (1.0 + q);
    r->upper -= r->lower * q;
    r->lower = 0.0;
}

static void close_last(struct row *r)
{
    const double q = r->upper / r->lower;

    r->middle += r->upper * (1.0 + q);
    r->lower -= r->upper * q;
    r->upper = 0.0;
}

/* Elimination from the first inner knot to the last, then back (the matrix is tridiagonal). */
static void solve(unsigned count, const double *knot, const double *value, double *second)
{
    double upper[SPLINE_KNOTS_MAX];
    struct row r;

    upper[0] = 0.0;
    second[0] = 0.0;
    for (unsigned i = 1; i + 1 < count; i++) {
        set_row(&r, knot + i, value + i);
        if (i == 1) {
            close_first(&r);
        }
        if (i + 2 == count) {
            close_last(&r);
        }
        const double pivot = r.middle - r.lower * upper[i - 1];

        upper[i] = r.upper / pivot;
        second[i] = (r.right - r.lower * second[i - 1]) / pivot;
    }
    for (unsigned i = count - 2; i-- > 1;) {
        second[i] -= upper[i] * second[i + 1];
    }
}

static double beyond(double near, double far, double outer, double inner)
{
    return near + (near - far) * outer / inner;
}

void takt_spline_second_derivatives(unsigned count, const double *knot, const double *value,
                                    double *second)
{
    TAKT_ASSERT(count >= 2 && count <= SPLINE_KNOTS_MAX);
    const unsigned last = count - 1;

    if (count == 2) {
        second[0] = second[1] = 0.0;
        return;
    }
    if (count == 3) {
        struct row r;

        set_row(&r, knot + 1, value + 1);
        second[0] = second[1] = second[2] = r.right / (1.5 * r.middle);
        return;
    }
    solve(count, knot, value, second);
    second[0] = beyond(second[1], second[2], knot[1] - knot[0], knot[2] - knot[1]);
    second[last] = beyond(second[last - 1], second[last - 2], knot[last] - knot[last - 1],
                          knot[last - 1] - knot[last - 2]);
}
