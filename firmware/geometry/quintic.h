/* A piece of a spline in a plane: told by curve.c what to do. */
#ifndef TAKT_GEOMETRY_QUINTIC_H
#define TAKT_GEOMETRY_QUINTIC_H

#include "geometry/curve.h"

void takt_quintic_point(const struct curve *c, double s_mm, struct point *p);
void takt_quintic_tangent(const struct curve *c, double s_mm, struct point *t);
void takt_quintic_curvature(const struct curve *c, double s_mm, struct point *k);
void takt_quintic_bound(const struct curve *c, struct curve_bounds *b);

/*
 * Where it runs across an axis of its plane (0, 1), s > 0: it is farthest there. False: it does not
 * turn so far.
 */
bool takt_quintic_extreme(const struct curve *c, unsigned in_plane, double *s_mm);

#endif
