/*
 * NURBS in a plane: control points and knots that come one by one -> pieces of quintics (curve.h),
 * each within a given error of the curve.
 *
 * A knot decides a span when the points and knots before it are known, so only 2 order - 1 of each
 * are kept, however many there are. A curve whose first knots are not all equal does not begin at
 * its first control point: a straight piece leads from there to where it does.
 */
#ifndef TAKT_GEOMETRY_NURBS_H
#define TAKT_GEOMETRY_NURBS_H

#include "geometry/curve.h"

#include <stdint.h>

#define NURBS_ORDER_MIN 2
#define NURBS_ORDER_MAX 6

/* Points and knots kept. */
#define NURBS_KEPT (2 * NURBS_ORDER_MAX - 1)

/* The least error that can be asked for: that of the exact path. */
#define NURBS_ERROR_MM 5e-10

struct nurbs {
    uint32_t order;              /* degree + 1 */
    uint32_t points, knots;      /* that have come */
    bool within;                 /* the span of the newest knot is not finished */
    double at_mm[2];             /* where the last piece ends; before the first the first point */
    double at;                   /* parameter up to which there are pieces */
    double point[NURBS_KEPT][3]; /* both coordinates times the weight, and the weight */
    double knot[NURBS_KEPT];
};

struct nurbs_piece {
    double
        end_mm[2]; /* it begins where the one before ends, the first at the first control point */
    struct curve_course course;
};

enum nurbs_result {
    NURBS_PIECE,
    NURBS_NONE, /* until the next knot */
    /* the curve turns back or stops within, where it has no direction: nothing more comes */
    NURBS_CUSP
};

void takt_nurbs_open(struct nurbs *n, unsigned order);

/* weight > 0 */
void takt_nurbs_add_point(struct nurbs *n, const double at_mm[2], double weight);

/*
 * Not below the one before. No more than order knots more than points; only after takt_nurbs_next
 * has said NURBS_NONE.
 */
void takt_nurbs_add_knot(struct nurbs *n, double knot);

/* error_mm: how far the piece may be off the curve, NURBS_ERROR_MM or more. */
enum nurbs_result takt_nurbs_next(struct nurbs *n, double error_mm, struct nurbs_piece *piece);

#endif
