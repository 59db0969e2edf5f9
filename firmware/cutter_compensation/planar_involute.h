/* Involutes in the plane of a contour: the cases of planar.h for them. Private to this room. */
#ifndef TAKT_CUTTER_COMPENSATION_PLANAR_INVOLUTE_H
#define TAKT_CUTTER_COMPENSATION_PLANAR_INVOLUTE_H

#include "cutter_compensation/planar.h"

void takt_planar_involute_tangent(const struct planar *c, double unrolled_rad, double result[2]);
double takt_planar_involute_curvature(const struct planar *c, double unrolled_rad);
/*
 * The same moved left: left of the way, as everywhere. Returns the smaller radius of curvature,
 * negative: none.
 */
double takt_planar_involute_offset(struct planar *c, double left_mm);
double takt_planar_involute_length(const struct planar *c);
double takt_planar_involute_place(const struct planar *c, const double point[2]);
/* The unrolled angle at a place. */
double takt_planar_involute_unrolled(const struct planar *c, double place_mm);

/*
 * Where an involute crosses another way, whose circle has that radius if it is an arc: of all
 * places within both, or beyond their ends by a little, the two nearest to the involute's end, or
 * to its start.
 */
unsigned takt_planar_involute_cross(const struct planar *c, const struct planar *other,
                                    double radius_mm, bool near_end, double points[2][2]);

/* Distance of a point, and of another way where both have a common normal. */
double takt_planar_involute_distance_point(const struct planar *c, const double point[2]);
double takt_planar_involute_distance(const struct planar *c, const struct planar *other);

#endif
