/*
 * What is to be milled, and the paths that do it.
 */
#ifndef TAKT_BORE_JOB_H
#define TAKT_BORE_JOB_H

#include "bore/path.h"
#include "bore/spiral.h"

#include <stdbool.h>

enum bore_pass { BORE_ROUGHING, BORE_FINISHING, BORE_BOTH };

/* What the spiral is written as; a helix is of roughing alone. */
enum bore_form_kind { BORE_AS_INVOLUTE, BORE_AS_ARCS, BORE_AS_LINES, BORE_AS_HELIX };

/* Where the spiral of a pass alone begins; of both passes that of finishing. */
enum bore_begin { BORE_AT_POINT, BORE_AT_RADIUS, BORE_AT_LENGTH };

/*
 * Involutes of programs turn 7957 times at most; the base circle that is written of a small hole is
 * rounded.
 */
#define BORE_TURNS_MAX 7500
/* Arcs of programs are no smaller. */
#define BORE_RADIUS_MIN_MM   0.0013
#define BORE_TOLERANCE_MIN   1e-6
#define BORE_DEPTH_STEPS_MAX 10000

/* 0 where something is not asked for. */
struct bore_job {
    enum bore_pass pass;
    double hole_mm;   /* diameter, > 0 */
    double cutter_mm; /* diameter, > 0 and smaller than the hole */
    double step_mm;   /* roughing: how much farther out a turn is, at most; > 0 */
    double
        allowance_mm; /* left on the radius: by roughing for finishing; by a finishing pass alone */
    unsigned turns;   /* finishing, >= 1 */
    enum bore_begin begin;
    double start_mm[2];     /* from the hole's centre: nearer to it than the circle */
    double start_radius_mm; /* BORE_AT_RADIUS: radius of curvature at the start */
    double start_length_mm; /* BORE_AT_LENGTH: of the way to the circle, > 0 */
    double direction_rad;   /* psi: the spiral leaves the centre so */
    double depth_mm;        /* >= 0; 0: at Z 0 */
    double depth_step_mm;   /* > 0: one turn of the work is at most so deep; 0: all at once */
    double height_mm;       /* above Z 0, where a plunge begins; > 0 */
    double feed_mm_min;     /* > 0 */
    double plunge_mm_min;   /* > 0 */
    double spindle_rpm;     /* 0: no spindle words */
    enum bore_form_kind as;
    double tolerance_mm; /* of arcs and lines, >= BORE_TOLERANCE_MIN */
};

/* NULL: good; else what is wrong with which value, a sentence valid until the next call. */
const char *bore_check(const struct bore_job *job);

/* The spiral of one pass, BORE_ROUGHING or BORE_FINISHING, of a job that has been checked. */
void bore_set_spiral(const struct bore_job *job, enum bore_pass pass, struct bore_spiral *s);

/* In how many steps the depth is reached, >= 1. */
unsigned bore_depth_steps(const struct bore_job *job);

/*
 * The way at one depth, from the start to where the next depth may begin: roughing spiral and
 * circle; or finishing spiral, circle and mirror image. bore_path_free is due; look at failed.
 */
void bore_make_path(const struct bore_job *job, enum bore_pass pass, struct bore_path *p);

#endif
