/*
 * How far setpoints are from curves, and corners from the setpoints' line: over all axes, where a
 * degree counts like a millimetre.
 */
#ifndef TAKT_TESTS_CHAIN_DISTANCE_H
#define TAKT_TESTS_CHAIN_DISTANCE_H

#include "base/maths.h"
#include "geometry/curve.h"

static inline double chain_weight(int axis)
{
    return axis < AXIS_LINEAR_COUNT ? 1.0 : 180.0 / MATHS_PI;
}

static inline double chain_distance(const struct point *a, const struct point *b)
{
    double square = 0.0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        const double off = chain_weight(i) * (a->at[i] - b->at[i]);

        square += off * off;
    }
    return maths_sqrt(square);
}

/* To where p lies across the curve, from s on, by Newton's method. */
static inline double chain_distance_across(const struct curve *c, const struct point *p, double s)
{
    struct point on;
    struct point t;

    for (int i = 0; i < 4; i++) {
        double along = 0.0;
        double square = 0.0;

        takt_curve_point(c, s, &on);
        takt_curve_tangent(c, s, &t);
        for (int axis = 0; axis < AXIS_COUNT; axis++) {
            const double weight = chain_weight(axis) * chain_weight(axis);

            along += weight * (p->at[axis] - on.at[axis]) * t.at[axis];
            square += weight * t.at[axis] * t.at[axis];
        }
        s = maths_clamp(s + along / square, 0.0, c->length_mm);
    }
    takt_curve_point(c, s, &on);
    return chain_distance(p, &on);
}

/* Curves of a turn at most: looked at from eight places. */
static inline double chain_distance_from(const struct curve *c, const struct point *p)
{
    const int places = c->kind == CURVE_LINE ? 1 : 8;
    double least = MATHS_INFINITY;

    for (int i = 0; i < places; i++) {
        const double s = c->length_mm * (i + 0.5) / places;

        least = maths_min(least, chain_distance_across(c, p, s));
    }
    return least;
}

/* Distance of a corner from the straight line between two setpoints. */
static inline double chain_corner_distance(const struct point *corner, const struct point *a,
                                           const struct point *b)
{
    struct curve c;

    return takt_curve_set_line(&c, a, b) ? chain_distance_across(&c, corner, 0.0)
                                         : chain_distance(corner, b);
}

#endif
