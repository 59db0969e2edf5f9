/*
 * Distance of a point from a programmed curve.
 */
#ifndef TAKT_HOST_VERIFIER_CURVE_H
#define TAKT_HOST_VERIFIER_CURVE_H

#include "geometry/curve.h"

/* Length of the difference of two points over all axes. */
double verifier_distance(const struct point *a, const struct point *b);

/*
 * Distance of p from c. *fraction: where on the curve, 0 ... 1; in: near which fraction to look,
 * because an arc of several turns passes the same angle again; out: where the nearest point is.
 *
 * For an arc the point compared with has the same angle, which is the nearest one of a circle and
 * never nearer than the nearest of a helix or an arc of changing radius: what is returned is an
 * upper bound there.
 */
double verifier_curve_distance(const struct curve *c, const struct point *p, double *fraction);

/* Deviation of the straight step between two points of the curve from it, at most; 0 for lines. */
double verifier_curve_chord_error(const struct curve *c, const struct point *from,
                                  const struct point *to);

#endif
