#include "takt/judge_curve.h"

#include "base/maths.h"

double judge_distance(const struct point *a, const struct point *b)
{
    double sum = 0;

    for (int i = 0; i < AXIS_COUNT; i++)
        sum += (a->at[i] - b->at[i]) * (a->at[i] - b->at[i]);
    return maths_sqrt(sum);
}

/* Nearest point of the line from a to b: a + f (b - a), f = (p - a)(b - a) / |b - a|^2, kept within 0 ... 1. */
static double line_distance(const struct curve *c, const struct point *p, double *fraction)
{
    double dot = 0, square = 0, sum = 0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        double way = c->end.at[i] - c->start.at[i];

        dot += (p->at[i] - c->start.at[i]) * way;
        square += way * way;
    }
    *fraction = maths_clamp(dot / square, 0, 1);
    for (int i = 0; i < AXIS_COUNT; i++) {
        double off = p->at[i] - c->start.at[i] - *fraction * (c->end.at[i] - c->start.at[i]);

        sum += off * off;
    }
    return maths_sqrt(sum);
}

/* Fraction of the arc at which its radius vector has the angle, near the fraction given. */
static double arc_fraction(const struct curve_arc *arc, double angle_rad, double near)
{
    double turn = MATHS_TWO_PI / maths_abs(arc->sweep_rad);
    double fraction = (angle_rad - arc->angle_start_rad) / arc->sweep_rad;

    fraction += turn * maths_round((near - fraction) / turn);
    return maths_clamp(fraction, 0, 1);
}

static double arc_distance(const struct curve *c, const struct point *p, double *fraction)
{
    const struct curve_arc *arc = &c->arc;
    double x = p->at[arc->first] - arc->centre_mm[0];
    double y = p->at[arc->second] - arc->centre_mm[1];
    double angle = maths_atan2(y, x);
    double f = arc_fraction(arc, angle, *fraction);
    double on = arc->angle_start_rad + f * arc->sweep_rad;
    double radius = arc->radius_start_mm + f * arc->radius_change_mm;
    double sine, cosine, sum;

    *fraction = f;
    maths_sincos(on, &sine, &cosine);
    sum = (x - radius * cosine) * (x - radius * cosine) + (y - radius * sine) * (y - radius * sine);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        double off = p->at[i] - c->start.at[i] - f * (c->end.at[i] - c->start.at[i]);

        if (i != arc->first && i != arc->second)
            sum += off * off;
    }
    return maths_sqrt(sum);
}

double judge_curve_distance(const struct curve *c, const struct point *p, double *fraction)
{
    return c->kind == CURVE_ARC ? arc_distance(c, p, fraction) : line_distance(c, p, fraction);
}

/*
 * Sagitta of the chord in the plane of the arc: h = R - sqrt(R^2 - l^2 / 4), written without cancellation as
 * h = (l^2 / 4) / (R + sqrt(R^2 - l^2 / 4)). Where the radius changes, R is its mean over the step: the chord's middle
 * then lies h off the curve, up to terms of third order.
 */
double judge_curve_chord_error(const struct curve *c, const struct point *from,
                               const struct point *to)
{
    const struct curve_arc *arc = &c->arc;
    double x0, y0, x1, y1, quarter, radius;

    if (c->kind != CURVE_ARC)
        return 0;
    x0 = from->at[arc->first] - arc->centre_mm[0];
    y0 = from->at[arc->second] - arc->centre_mm[1];
    x1 = to->at[arc->first] - arc->centre_mm[0];
    y1 = to->at[arc->second] - arc->centre_mm[1];
    quarter = ((x1 - x0) * (x1 - x0) + (y1 - y0) * (y1 - y0)) / 4;
    radius = (maths_sqrt(x0 * x0 + y0 * y0) + maths_sqrt(x1 * x1 + y1 * y1)) / 2;
    return quarter / (radius + maths_sqrt(maths_max(radius * radius - quarter, 0)));
}
