/*
 * Involutes of a circle: the cases of curve.h for CURVE_INVOLUTE.
 *
 * On the base circle the curvature is infinite, so a piece that begins or ends there must be gone
 * from, or to, rest. Then no limit of feed is needed: with jerk along the path of at most j from
 * rest at the cusp,
 *
 *     |a| <= sqrt(2 j v),  v^3 <= (9/2) j s^2,  v^2 <= 2 a_max s
 *
 * and with curvature k = 1 / sqrt(2 r s) = 1 / (r phi), the heading turned by phi since the cusp,
 *
 *     acceleration across   k v^2                          <= a_max phi
 *     jerk along            |j - k^2 v^3|                  <= j (1 + 9/8 phi^2)
 *     jerk across           |k' v^3 + 3 k v a|             <= j 45/8 phi          (9/8 phi and 9/2 phi)
 *
 * The same holds backwards, to rest.
 */
#ifndef TAKT_GEOMETRY_INVOLUTE_H
#define TAKT_GEOMETRY_INVOLUTE_H

#include "geometry/curve.h"

/* The curvature of an involute at one place, and how fast that changes. */
struct involute_curvature {
    double curvature_1_mm; /* |d2x/ds2| */
    double change_1_mm2;   /* |d curvature / d s| */
};

void takt_involute_point(const struct curve *c, double s_mm, struct point *p);
void takt_involute_tangent(const struct curve *c, double s_mm, struct point *t);
void takt_involute_curvature(const struct curve *c, double s_mm, struct point *k);
void takt_involute_bound(const struct curve *c, struct curve_bounds *b);
double takt_involute_piece_end(const struct curve *c, double from_mm);
void takt_involute_cut(const struct curve *c, double from_mm, double to_mm, struct curve *piece);

/* Finite on the base circle too: then far above what any machine can follow. */
struct involute_curvature takt_involute_curvature_change(const struct curve *c, double s_mm);

/* Angle unrolled at s, >= 0. */
double takt_involute_unrolled(const struct curve *c, double s_mm);

/* Where the unrolled angle is that: the inverse. */
double takt_involute_place(const struct curve *c, double unrolled_rad);

/*
 * phi - atan phi, phi = sqrt((d / r)^2 - 1): how far the vector from the centre has turned since
 * the base circle when it is d long. 0 inside the base circle.
 */
double takt_involute_turned(double distance_mm, double radius_mm);

/*
 * The outermost place whose heading is quarter pi / 2: there the curve is farthest in one direction
 * of its plane. False: it does not reach that heading.
 */
bool takt_involute_extreme(const struct curve *c, unsigned quarter, double *s_mm);

/*
 * By how much longer than along the path acceleration and jerk are within a piece that turns by
 * cusp_rad from the base circle: sqrt(1 + phi^2), sqrt((1 + 9/8 phi^2)^2 + (45/8 phi)^2).
 */
double takt_involute_cusp_acceleration(double cusp_rad);
double takt_involute_cusp_jerk(double cusp_rad);

/*
 * Longest step whose chord leaves the curve by error_mm at most, wherever it begins. It is the one
 * from the base circle, where the curve is y = sqrt(8 / (9 r)) x^(3/2) and a chord of length l
 * leaves it by (4/27) sqrt(8 / (9 r)) l^(3/2).
 */
double takt_involute_step_max(const struct curve *c, double error_mm);

#endif
