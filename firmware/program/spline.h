/*
 * Splines: G5, G5.1, G5.2 with G5.3, and G6.2.
 *
 * All are NURBS in the plane (geometry/nurbs.h), which become pieces, moves of kind MOVE_SPLINE, as
 * they are fetched: no number of control points needs room. What a line decides has been checked as
 * a whole before.
 */
#ifndef TAKT_PROGRAM_SPLINE_H
#define TAKT_PROGRAM_SPLINE_H

#include "program/program.h"

enum spline {
    SPLINE_CUBIC,     /* G5: I J from the start, P Q from the end to the points between */
    SPLINE_QUADRATIC, /* G5.1: I J from the start to the point between */
    /* G5.2: control points, P their weights, L the order; even knots, open at the ends */
    SPLINE_POINTS,
    SPLINE_END,  /* G5.3 */
    SPLINE_KNOTS /* G6.2: control points, R their weights, K the knots, P the order */
};
bool takt_spline_start(struct program *p, const struct program_code *code);

/* Between the first and the last control point only F may come. False: p->error is set. */
bool takt_spline_allows(struct program *p, const struct program_code *code);

/* The text ends. False: within a spline, p->error is set. */
bool takt_spline_ends(struct program *p);

/* The next piece; false: there is none until the next line. */
bool takt_spline_next(struct program *p, struct move *move);

#endif
