#include "geometry/place.h"

#include "base/maths.h"

/* f = (p - a)(b - a) / |b - a|^2 */
static double line_place(const struct curve *c, const struct point *p)
{
    double way = 0.0;
    double square = 0.0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        const double whole = c->end.at[i] - c->start.at[i];

        way += (p->at[i] - c->start.at[i]) * whole;
        square += whole * whole;
    }
    return way / square;
}

/* By the angle of the radius vector, in which everything about an arc is linear. */
static double arc_place(const struct curve *c, const struct point *p, double near)
{
    const double x = p->at[c->arc.first] - c->arc.centre_mm[0];
    const double y = p->at[c->arc.second] - c->arc.centre_mm[1];
    const double turn = MATHS_TWO_PI / maths_abs(c->arc.sweep_rad);
    const double part = (takt_maths_atan2(y, x) - c->arc.angle_start_rad) / c->arc.sweep_rad;

    return part + turn * takt_maths_round((near - part) / turn);
}

double takt_curve_place(const struct curve *c, const struct point *p, double near)
{
    if (c->kind == CURVE_LINE) {
        return line_place(c, p);
    }
    return c->kind == CURVE_ARC ? arc_place(c, p, near) : -1.0;
}
