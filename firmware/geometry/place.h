/*
 * Where on a curve a point is: the inverse of takt_curve_point, for points on the curve or beside
 * it.
 */
#ifndef TAKT_GEOMETRY_PLACE_H
#define TAKT_GEOMETRY_PLACE_H

#include "geometry/curve.h"

/*
 * Part of the way, 0 at the start and 1 at the end, of the point of a line or arc that is nearest
 * to p; not limited to 0 ... 1. Of the turns of an arc the one nearest to near, a part of the way
 * as well. Other curves: -1.
 */
double takt_curve_place(const struct curve *c, const struct point *p, double near);

#endif
