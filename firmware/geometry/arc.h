/* Arcs, helices and arcs of changing radius: the cases of curve.h for CURVE_ARC. */
#ifndef TAKT_GEOMETRY_ARC_H
#define TAKT_GEOMETRY_ARC_H

#include "geometry/curve.h"

void takt_arc_point(const struct curve *c, double s_mm, struct point *p);
void takt_arc_tangent(const struct curve *c, double s_mm, struct point *t);
void takt_arc_point_and_tangent(const struct curve *c, double s_mm, struct point *p,
                                struct point *t);
void takt_arc_curvature(const struct curve *c, double s_mm, struct point *k);
void takt_arc_bound(const struct curve *c, struct curve_bounds *b);

#endif
