/*
 * A cubic in its parameter s, which is no arc length: the feed along it is |dx/ds| times that of s.
 *     x(s) = start + slope s + square s^2 + cube s^3
 */
#include "geometry/spline.h"

#include "base/maths.h"

#include <string.h>

/* What all axes of a piece multiply their differences by: 1/2d, 1/2d^2, 1/6d^3. */
struct factors {
    double first, second, third;
};

/*
 * One axis, of four control points. An axis that does not move is where they are, to the last bit.
 */
static void set_axis(struct curve *c, int i, const struct point control[4],
                     const struct factors *by)
{
    const double c0 = control[0].at[i];
    const double c1 = control[1].at[i];
    const double c2 = control[2].at[i];
    const double c3 = control[3].at[i];

    c->start.at[i] = c->end.at[i] = c0;
    c->slope.at[i] = c->spline.square.at[i] = c->spline.cube.at[i] = 0.0;
    if (c0 == c1 && c1 == c2 && c2 == c3) {
        return;
    }
    const double second = (c0 - c1) + (c2 - c1);
    const double second_end = (c1 - c2) + (c3 - c2);

    c->spline.moves |= (unsigned char)(1U << i);
    c->start.at[i] = c1 + second * (1.0 / 6.0);
    c->end.at[i] = c2 + second_end * (1.0 / 6.0);
    c->slope.at[i] = (c2 - c0) * by->first;
    c->spline.square.at[i] = second * by->second;
    c->spline.cube.at[i] = (second_end - second) * by->third;
}

/*
 * For four control points of a uniform cubic B-spline, with d = length the way of s from one to the
 * next:
 *     start  = c1 + (c0 - 2 c1 + c2)/6            slope = (c2 - c0)/(2 d)
 *     square = (c0 - 2 c1 + c2)/(2 d^2)           cube  = (c3 - 3 c2 + 3 c1 - c0)/(6 d^3)
 */
void takt_curve_set_spline(struct curve *c, const struct point control[4], double length_mm)
{
    const double inverse_mm = 1.0 / length_mm;
    const double half = 0.5 * inverse_mm;
    const struct factors by = {
        .first = half,
        .second = half * inverse_mm,
        .third = inverse_mm * inverse_mm * inverse_mm * (1.0 / 6.0),
    };

    c->kind = CURVE_SPLINE;
    c->rotary = false;
    c->length_mm = length_mm;
    c->spline.moves = 0;
    for (int i = 0; i < AXIS_COUNT; i++) {
        set_axis(c, i, control, &by);
    }
}

void takt_spline_point(const struct curve *c, double s_mm, struct point *p)
{
    *p = c->start;
    for (int i = 0; i < AXIS_COUNT; i++) {
        if ((c->spline.moves & 1U << i) != 0) {
            const double curved = c->spline.square.at[i] + c->spline.cube.at[i] * s_mm;

            p->at[i] += (c->slope.at[i] + curved * s_mm) * s_mm;
        }
    }
}

void takt_spline_tangent(const struct curve *c, double s_mm, struct point *t)
{
    for (int i = 0; i < AXIS_COUNT; i++) {
        const double curved = 2.0 * c->spline.square.at[i] + 3.0 * c->spline.cube.at[i] * s_mm;

        t->at[i] = c->slope.at[i] + curved * s_mm;
    }
}

void takt_spline_curvature(const struct curve *c, double s_mm, struct point *k)
{
    for (int i = 0; i < AXIS_COUNT; i++) {
        k->at[i] = 2.0 * c->spline.square.at[i] + 6.0 * c->spline.cube.at[i] * s_mm;
    }
}

/* The tangent is a parabola: it exceeds both its ends by |third| length^2 / 8 at most. */
void takt_spline_bound(const struct curve *c, struct curve_bounds *b)
{
    struct point tangent;
    struct point second;

    memset(b, 0, sizeof(*b));
    takt_spline_tangent(c, c->length_mm, &tangent);
    takt_spline_curvature(c, c->length_mm, &second);
    for (int i = 0; i < AXIS_COUNT; i++) {
        const double third = 6.0 * maths_abs(c->spline.cube.at[i]);
        const double ends = maths_max(maths_abs(c->slope.at[i]), maths_abs(tangent.at[i]));

        b->first[i] = ends + third * c->length_mm * c->length_mm / 8.0;
        b->second[i] = maths_max(2.0 * maths_abs(c->spline.square.at[i]), maths_abs(second.at[i]));
        b->third[i] = third;
    }
}
