/* Straight lines: the cases of curve.h for CURVE_LINE. */
#ifndef TAKT_GEOMETRY_LINE_H
#define TAKT_GEOMETRY_LINE_H

#include "geometry/curve.h"

void takt_line_point(const struct curve *c, double s_mm, struct point *p);
void takt_line_bound(const struct curve *c, struct curve_bounds *b);

#endif
