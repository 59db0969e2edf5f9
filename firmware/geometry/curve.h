/*
 * A piece of path, told by its arc length.
 *
 * The path length s counts millimetres along X, Y, Z if they move by CURVE_LENGTH_MIN_MM; else
 * radians along A, B, C. Points, first and second derivatives by s are closed forms; nothing here
 * knows time.
 */
#ifndef TAKT_GEOMETRY_CURVE_H
#define TAKT_GEOMETRY_CURVE_H

#include "base/point.h"

#include <stdbool.h>

/* Less than this is rounding of coordinates: no motion. */
#define CURVE_LENGTH_MIN_MM 1e-9

/*
 * An involute is unrolled by this at most, some 15,900 turns: up to there angles are exact
 * (base/maths.h).
 */
#define CURVE_UNROLLED_MAX_RAD 1e5

enum curve_kind { CURVE_LINE, CURVE_ARC, CURVE_INVOLUTE, CURVE_QUINTIC, CURVE_SPLINE };

/*
 * The plane of a curved curve: its first and second axis in the sense of G17 (X, Y), G18 (Z, X),
 * G19 (Y, Z).
 */
enum plane { PLANE_XY, PLANE_ZX, PLANE_YZ };

/*
 * The part of an arc that a line does not have. Everything about an arc is linear in its fraction
 * f, 0 at the start and 1 at the end: the angle, the radius (equal at both ends for a true circle)
 * and every axis outside the plane.
 */
struct curve_arc {
    unsigned char first, second; /* axes of the plane */
    double centre_mm[2];
    double radius_start_mm;
    double radius_change_mm; /* radius at the end minus radius at the start */
    double angle_start_rad;  /* of the radius vector at s = 0 */
    double sweep_rad;        /* signed, counter-clockwise > 0, several turns allowed */
    /*
     * f(s) = u + u (1 - u) (skew_start (1 - u) - skew_end u), u = s / length: 0 for a true circle.
     */
    double skew_start;
    double skew_end;
};

/*
 * The part of an involute that a line does not have (involute.c). The string is unrolled from the
 * base circle by the angle phi; phi^2 is linear in s, and so is every axis outside the plane.
 */
struct curve_involute {
    unsigned char first, second; /* axes of the plane */
    bool outward;                /* phi grows along the curve */
    bool cusp_start, cusp_end;   /* it starts, or ends, on the base circle or as good as there */
    double centre_mm[2];         /* of the base circle */
    double radius_mm;            /* of the base circle, > 0 */
    double hand;                 /* 1: unrolled counter-clockwise, -1: clockwise */
    /* of the curve on the base circle, away from it; also that point's angle there */
    double heading_rad;
    double square_start_rad2;   /* phi^2 at s = 0 */
    double square_rate_rad2_mm; /* d phi^2 / d s */
    double plane_ratio;         /* length in the plane / length, <= 1 */
};

/*
 * The part of a piece of a spline that a line does not have (quintic.c). Only the axes of its plane
 * move.
 */
struct curve_quintic {
    unsigned char first, second; /* axes of the plane */
    double coefficient_mm[2][4]; /* c2 ... c5 of both */
};

/*
 * How a piece of a spline runs between its ends: direction and curvature at both,
 * counter-clockwise > 0.
 */
struct curve_course {
    double heading_rad[2];
    double curvature_1_mm[2];
    double length_mm;
};

/* The part of a cubic that a line does not have (spline.c). Its s is no arc length. */
struct curve_spline {
    unsigned char moves; /* bit i set: axis i does */
    struct point square; /* half of d2 axis / d s2 at s = 0 */
    struct point cube;   /* a sixth of d3 axis / d s3 */
};

struct curve {
    enum curve_kind kind;
    bool rotary;      /* the length counts radians: no linear axis moves, but for rounding */
    double length_mm; /* > 0 */
    struct point start, end;
    /*
     * d axis / d s of every axis (of an arc: d axis / d (f length)); 0 in the plane of a curved
     * curve
     */
    struct point slope;
    union {
        struct curve_arc arc;           /* kind CURVE_ARC alone */
        struct curve_involute involute; /* kind CURVE_INVOLUTE alone */
        struct curve_quintic quintic;   /* kind CURVE_QUINTIC alone */
        struct curve_spline spline;     /* kind CURVE_SPLINE alone */
    };
};

/*
 * How sharply a curve turns at most, for limits: bounds on derivatives by s, over the whole curve.
 */
struct curve_bounds {
    double first[AXIS_COUNT];  /* max |dx_i/ds| */
    double second[AXIS_COUNT]; /* max |d2x_i/ds2|, 1/mm */
    double third
        [AXIS_COUNT]; /* max |d3x_i/ds3|, 1/mm2; in an involute's plane its part along the path */
    double radius_min_mm; /* smallest radius of curvature; 0: straight */
    /* The plane of a curved curve: how far from a circle's. Both are 0 for a circle. */
    double second_along; /* max part of d2x/ds2 along the path, 1/mm */
    double third_across; /* max part of d3x/ds3 across it, 1/mm2 */
    /*
     * Not 0: an involute that starts or ends on its base circle, where it has no curvature that
     * could be told; by how much its heading turns from there. second and third of its plane are
     * infinite, see involute.h for what holds.
     */
    double cusp_rad;
};

/*
 * Line from start to end. False when it is shorter than CURVE_LENGTH_MIN_MM (or as many rad): *c is
 * then not usable.
 */
bool takt_curve_set_line(struct curve *c, const struct point *start, const struct point *end);

/*
 * Arc or helix from start to end about centre_mm (absolute, first and second axis of the plane),
 * turns >= 1: a full circle when start and end coincide in the plane. Radii at start and end may
 * differ: the radius then changes linearly with the angle. False when either radius is 0 or the arc
 * is shorter than CURVE_LENGTH_MIN_MM.
 */
bool takt_curve_set_arc(struct curve *c, const struct point *start, const struct point *end,
                        enum plane plane, const double centre_mm[2], bool clockwise,
                        unsigned turns);
/* The same in two halves, for a control cycle that has no time for both. */
void takt_curve_begin_arc(struct curve *c, const struct point *start, const struct point *end,
                          enum plane plane, const double centre_mm[2]);
bool takt_curve_end_arc(struct curve *c, bool clockwise, unsigned turns);

/*
 * Involute of a circle from start to end, turning clockwise or not; every other axis moves in
 * proportion to the length. centre_mm, base_radius_mm: the base circle. Start and end may be a
 * little off the involute and even a little inside the base circle; the curve is then an involute
 * through both that is nowhere farther off than they are (involute.c). False when both are equally
 * far from the centre, one of them is in it, or farther than CURVE_UNROLLED_MAX_RAD times the
 * radius, or both are inside the base circle, or the curve is shorter than CURVE_LENGTH_MIN_MM.
 */
bool takt_curve_set_involute(struct curve *c, const struct point *start, const struct point *end,
                             enum plane plane, const double centre_mm[2], double base_radius_mm,
                             bool clockwise);

/*
 * Piece of a spline in a plane, short enough that its course tells it (nurbs.c). No other axis
 * moves. False when it is shorter than CURVE_LENGTH_MIN_MM.
 */
bool takt_curve_set_quintic(struct curve *c, const struct point *start, const struct point *end,
                            enum plane plane, const struct curve_course *course);

/*
 * Piece of a uniform cubic B-spline between the second and the third of four control points; s goes
 * 0 ... length_mm > 0 evenly with the spline's parameter. Counts as linear: set rotary when only
 * rotary axes move.
 */
void takt_curve_set_spline(struct curve *c, const struct point control[4], double length_mm);

/*
 * Where the piece of c that begins at from_mm ends: within one piece the curvature changes by a
 * bounded ratio, so that one limit of feed serves it. Only involutes have more than one piece.
 */
double takt_curve_piece_end(const struct curve *c, double from_mm);

/*
 * The part of c between two places, 0 <= from < to <= length. Lines and arcs have one piece,
 * themselves.
 */
void takt_curve_cut(const struct curve *c, double from_mm, double to_mm, struct curve *piece);

/*
 * True when it starts, or ends, on the base circle of an involute: the curvature there is infinite,
 * and the axes must stand.
 */
bool takt_curve_starts_at_cusp(const struct curve *c);
bool takt_curve_ends_at_cusp(const struct curve *c);

/* The plane of a curved curve; false: a line. */
bool takt_curve_plane(const struct curve *c, enum axis *first, enum axis *second);

/* True when s counts radians of rotary axes, because no linear axis moves. */
bool takt_curve_is_rotary(const struct curve *c);

/* Point at 0 <= s <= length. At the length it is the end but for rounding. */
void takt_curve_point(const struct curve *c, double s_mm, struct point *p);

/* d point / d s and d2 point / d s2 at s. */
void takt_curve_tangent(const struct curve *c, double s_mm, struct point *t);
/* Both, which have much in common. */
void takt_curve_point_and_tangent(const struct curve *c, double s_mm, struct point *p,
                                  struct point *t);
void takt_curve_curvature(const struct curve *c, double s_mm, struct point *k);

void takt_curve_bound(const struct curve *c, struct curve_bounds *b);

/* First and second axis of a plane. */
void takt_plane_axes(enum plane plane, enum axis *first, enum axis *second);

#endif
