/*
 * A cubic in its parameter s, which is no arc length: the feed along it is |dx/ds| times that of s.
 *     x(s) = start + slope s + second s^2/2 + third s^3/6
 */
#include "geometry/spline.h"

#include "base/maths.h"

#include <string.h>

/*
 * Of four control points of a uniform cubic B-spline, with d = length the way of s from one to the next:
 *     start  = (c0 + 4 c1 + c2)/6        slope = (c2 - c0)/(2 d)
 *     second = (c0 - 2 c1 + c2)/d^2      third = (c3 - 3 c2 + 3 c1 - c0)/d^3
 */
void curve_set_spline(struct curve *c, const struct point control[4], double length_mm)
{
    memset(c, 0, sizeof(*c));
    c->kind = CURVE_SPLINE;
    c->length_mm = length_mm;
    for (int i = 0; i < AXIS_COUNT; i++) {
        const double c0 = control[0].at[i];
        const double c1 = control[1].at[i];
        const double c2 = control[2].at[i];
        const double c3 = control[3].at[i];

        c->start.at[i] = (c0 + 4.0 * c1 + c2) / 6.0;
        c->end.at[i] = (c1 + 4.0 * c2 + c3) / 6.0;
        c->slope.at[i] = (c2 - c0) / (2.0 * length_mm);
        c->spline.second.at[i] = ((c0 - c1) + (c2 - c1)) / (length_mm * length_mm);
        c->spline.third.at[i] = ((c3 - c0) - 3.0 * (c2 - c1)) / (length_mm * length_mm * length_mm);
    }
}

void spline_point(const struct curve *c, double s_mm, struct point *p)
{
    for (int i = 0; i < AXIS_COUNT; i++) {
        const double bent = 0.5 * c->spline.second.at[i] + c->spline.third.at[i] * s_mm / 6.0;

        p->at[i] = c->start.at[i] + (c->slope.at[i] + bent * s_mm) * s_mm;
    }
}

void spline_tangent(const struct curve *c, double s_mm, struct point *t)
{
    for (int i = 0; i < AXIS_COUNT; i++) {
        const double bent = c->spline.second.at[i] + 0.5 * c->spline.third.at[i] * s_mm;

        t->at[i] = c->slope.at[i] + bent * s_mm;
    }
}

void spline_curvature(const struct curve *c, double s_mm, struct point *k)
{
    for (int i = 0; i < AXIS_COUNT; i++) {
        k->at[i] = c->spline.second.at[i] + c->spline.third.at[i] * s_mm;
    }
}

/* The tangent is a parabola: it exceeds both its ends by |third| length^2 / 8 at most. */
void spline_bound(const struct curve *c, struct curve_bounds *b)
{
    struct point tangent;
    struct point bend;

    memset(b, 0, sizeof(*b));
    spline_tangent(c, c->length_mm, &tangent);
    spline_curvature(c, c->length_mm, &bend);
    for (int i = 0; i < AXIS_COUNT; i++) {
        const double third = maths_abs(c->spline.third.at[i]);
        const double ends = maths_max(maths_abs(c->slope.at[i]), maths_abs(tangent.at[i]));

        b->first[i] = ends + third * c->length_mm * c->length_mm / 8.0;
        b->second[i] = maths_max(maths_abs(c->spline.second.at[i]), maths_abs(bend.at[i]));
        b->third[i] = third;
    }
}
