/*
 * What the second verifier verifies: a programmed path, cut into straight pieces, and the setpoints
 * of a trace.
 *
 * Lengths are over all axes, in mm, a radian counts as one.
 */
#ifndef TAKT_TESTS_HUNT_CASE_H
#define TAKT_TESTS_HUNT_CASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#define AXES_MAX 6

/*
 * In exact paths the order is verified with so much room; distances from the curve are told to 1e-9
 * mm.
 */
#define ORDER_MM 1e-7

/* What rounding to the trace's nine decimals puts off one axis. */
#define ROUNDING 0.5e-9

struct motion {
    unsigned line;       /* of the program */
    bool is_arc;         /* helices and spirals too */
    bool is_rapid;       /* no feed */
    bool stops;          /* at its end */
    double tolerance_mm; /* 0: exact */
    double time_s;       /* at the programmed feed */
    double start[AXES_MAX], end[AXES_MAX];
    unsigned first, second;         /* axes of the arc's plane, */
    double centre[2], sweep_rad;    /* its centre and signed angle, */
    double angle_rad, radius_mm[2]; /* where it begins, radius there and at its end */
    double linear_mm, turning_rad;  /* length over X Y Z; over A B C */
};

struct piece {
    size_t motion;
    double start[AXES_MAX], way[AXES_MAX];
    double square_mm2, length_mm;
    double from, to;     /* parts of the motion */
    double tolerance_mm; /* with what it may be off the arc */
    bool ends;           /* with its motion */
};

struct span {
    double first, last; /* first > last: nothing */
};

struct verifier {
    unsigned axes, linear_axes; /* X Y Z come first */
    double scale[AXES_MAX];     /* mm or rad per unit of the trace */
    double limit[AXES_MAX][3];  /* units of the trace */
    double cycle_s, feed_factor;
    bool stands;    /* the axes do, after the last row */
    bool completed; /* they stand at the end of the path; else it may be left anywhere */
    double start[AXES_MAX];
    struct motion *motion;
    size_t motions, motion_room;
    struct piece *piece;
    size_t pieces, piece_room;
    double *setpoint; /* rows of `axes` numbers, mm and rad; row 0 is where the program starts */
    double *bend;     /* second difference at each row */
    size_t rows, row_room;
    struct span *reach;       /* of each piece: where the last setpoint may be */
    uint64_t work, work_most; /* pieces looked at beside a step; of more a walk is tired */
};

/* Ends the program with a reason. */
void fail(const char *what);
/* Zeros; never NULL. */
void *make(size_t count, size_t size);
/* Keeps the largest value, and where it is. */
void note(double *worst, unsigned *line, double value, unsigned where);
double length_of(const double *v, unsigned from, unsigned to);
/* Point of a motion at a part of it. */
void place(const struct verifier *j, const struct motion *m, double part, double *p);
/* Setpoint of a row; before the first and after the last the axes stand. */
const double *row_of(const struct verifier *j, size_t k);
void step_of(const struct verifier *j, size_t k, double *step);
/* One more motion, which begins where the last one ends; the rest of it is to be set. */
struct motion *add_motion(struct verifier *j);
/* Once it is set: what follows from it. */
void measure_motion(const struct verifier *j, struct motion *m);
/* One more setpoint, to be set; the first is where the program starts. */
double *add_row(struct verifier *j);
void read_case(struct verifier *j, FILE *file);
/* The motions, into pieces. */
void cut(struct verifier *j);
void read_trace(struct verifier *j, FILE *file);
void measure_bends(struct verifier *j);
void free_case(struct verifier *j);

#endif
