/*
 * A piece of contour in its plane: a line, an arc or an involute, with the operations compensation
 * needs. Coordinates are the first and second axis of the plane, mm. Left is left of the way when
 * the third axis points at the observer.
 */
#ifndef TAKT_CUTTER_COMPENSATION_PLANAR_H
#define TAKT_CUTTER_COMPENSATION_PLANAR_H

#include <stdbool.h>
#include <stdint.h>

struct planar {
    double from[2], to[2];
    double centre[2]; /* of an arc, or of an involute's base circle */
    union {
        struct {
            double radius_from,
                radius_to;    /* arcs: differ when an end is not exactly on the circle */
            double sweep_rad; /* arcs: > 0, also more than a turn */
        };
        struct { /* involutes, as in struct curve_involute */
            double base_mm;
            double heading_rad;
            double unrolled_from,
                unrolled_to; /* at the ends; the way goes outward when the second is larger */
        };
    };
    bool arc, involute;
    int8_t sense; /* arcs: 1 counter-clockwise, -1 clockwise */
    int8_t hand;  /* involutes, as in struct curve_involute */
};

/* A line; false when it has no length. */
bool takt_planar_set_line(struct planar *c, const double from[2], const double to[2]);

/* An arc about centre; from = to is a full circle. turns: as in struct move. */
void takt_planar_set_arc(struct planar *c, const double from[2], const double to[2],
                         const double centre[2], double sense, unsigned turns);

/* An involute of the circle about centre with that radius; false when it has no length. */
bool takt_planar_set_involute(struct planar *c, const double from[2], const double to[2],
                              const double centre[2], double base_mm, bool clockwise);

/* Direction of the way at its ends, length 1. */
void takt_planar_tangent_from(const struct planar *c, double tangent[2]);
void takt_planar_tangent_to(const struct planar *c, double tangent[2]);

/* Curvature at its ends, 1 / radius, to the left > 0; a line: 0. */
double takt_planar_curvature_from(const struct planar *c);
double takt_planar_curvature_to(const struct planar *c);

/*
 * The same piece moved left by left_mm, which may be negative. False when an arc or an involute
 * would have no radius left; *lack_mm is then how much its radius is too small.
 */
bool takt_planar_offset(const struct planar *c, double left_mm, struct planar *result,
                        double *lack_mm);

double takt_planar_length(const struct planar *c);

/*
 * Where a point of the way's line or circle lies on it, in mm from its start: negative before it.
 * On an arc the place nearest to its middle, so of places a turn apart one is chosen.
 */
double takt_planar_place(const struct planar *c, const double point[2]);

/*
 * The same, on an arc of more than half a turn the place that belongs to its end, or to its start.
 */
double takt_planar_place_near_to(const struct planar *c, const double point[2]);
double takt_planar_place_near_from(const struct planar *c, const double point[2]);

/* Lets the way end, or begin, at that place, whose point is given. */
void takt_planar_end_at(struct planar *c, double place_mm, const double point[2]);
void takt_planar_begin_at(struct planar *c, double place_mm, const double point[2]);

/*
 * Where the lines or circles of two ways cross, no matter how long the ways are: 0 to 2 points. Of
 * an arc with two radii the circle of its end counts for a, that of its start for b.
 */
unsigned takt_planar_cross(const struct planar *a, const struct planar *b, double points[2][2]);

/* Smallest distance of two ways, and of a point from a way. */
double takt_planar_distance(const struct planar *a, const struct planar *b);
double takt_planar_distance_point(const struct planar *c, const double point[2]);

static inline double planar_dot(const double a[2], const double b[2])
{
    return a[0] * b[0] + a[1] * b[1];
}

/* > 0: b points to the left of a */
static inline double planar_turn(const double a[2], const double b[2])
{
    return a[0] * b[1] - a[1] * b[0];
}

/* Distance of two points. */
double takt_planar_between(const double a[2], const double b[2]);

#endif
