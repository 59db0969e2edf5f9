/*
 * An arc of unit steps through any number of quadrants and octants. Radially the error stays below
 * one step, and the end is exact.
 */
#ifndef TAKT_STEP_EVALUATE_ARC_H
#define TAKT_STEP_EVALUATE_ARC_H

#include "step/evaluate.h"
#include "step/evaluate_line.h"

#include <stdbool.h>

struct evaluate_arc_config {
    enum evaluate_form form;
    int64_t start[2]; /* from the centre, first and second axis of the plane; not both 0 */
    int64_t end[2];   /* likewise, within a step of the circle */
    bool clockwise;
    unsigned
        turns; /* whole turns before the rest from start to end; 1 and equal ends: a full circle */
};

/*
 * Inside, the arc turns clockwise about the origin in coordinates a and b; counter-clockwise swaps
 * them.
 */
struct evaluate_arc {
    enum evaluate_form form;
    bool swapped;
    int64_t at[2];           /* a, b */
    int64_t end[2];          /* a, b */
    int64_t function;        /* F = a^2 + b^2 - R^2 */
    unsigned quadrant;       /* 0: from b axis to a axis, then clockwise */
    unsigned passed;         /* quadrants left behind */
    unsigned quadrants_left; /* that begin before the one with the end is reached */
    bool straight;           /* one end coordinate is reached: a line does the rest */
    struct evaluate_line rest;
    double radius;    /* R */
    double start_rad; /* from the beginning of the first quadrant to the start */
    double sweep_rad; /* from start to end, >= 0 */
};

void takt_evaluate_arc_begin(struct evaluate_arc *arc, const struct evaluate_arc_config *config);

/*
 * The next tick; bit 0 of its masks is the first axis of the plane, bit 1 the second. False: the
 * end is reached.
 */
bool takt_evaluate_arc_next(struct evaluate_arc *arc, struct evaluate_tick *tick);

/*
 * Ticks a second for a path speed of one step a second, here and now: improved max(|a|, |b|) / R,
 * plain (|a| + |b|) / R. It follows the angle, so that the path is passed at constant speed.
 */
double takt_evaluate_arc_rate(const struct evaluate_arc *arc);

/* Angle of the point from the start, rad, in the sense of turning. */
double takt_evaluate_arc_angle(const struct evaluate_arc *arc);

#endif
