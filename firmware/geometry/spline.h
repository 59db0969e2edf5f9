/* A piece of a cubic spline: told by curve.c what to do. */
#ifndef TAKT_GEOMETRY_SPLINE_H
#define TAKT_GEOMETRY_SPLINE_H

#include "geometry/curve.h"

void takt_spline_point(const struct curve *c, double s_mm, struct point *p);
void takt_spline_tangent(const struct curve *c, double s_mm, struct point *t);
void takt_spline_curvature(const struct curve *c, double s_mm, struct point *k);
void takt_spline_bound(const struct curve *c, struct curve_bounds *b);

#endif
