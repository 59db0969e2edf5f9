/*
 * Smooths the samples of a window inside the tolerance, at fixed timing (README.md).
 */
#ifndef TAKT_SMOOTH_RELAX_H
#define TAKT_SMOOTH_RELAX_H

#include "smooth/window.h"

/*
 * Corners of the route in a window that are looked at one by one, half as many where there are two
 * groups of lanes; of those behind them the verifier alone knows.
 */
#define RELAX_CORNERS_MAX 32

/* Values of all lanes at every sample: one group of lanes after the other. */
typedef lanes relax_rows[SMOOTH_SAMPLES_MAX];

/*
 * Corners, and the places of the curve that pass them; lengths as parts of the tolerance, groups as
 * of the rows.
 */
struct relax_corners {
    unsigned count;
    unsigned capacity;
    unsigned char piece[RELAX_CORNERS_MAX]; /* in which the curve passes it, */
    float fraction[RELAX_CORNERS_MAX];      /* and where in that */
    float most[RELAX_CORNERS_MAX];          /* how near it must be, as a part of the tolerance */
    lanes along[RELAX_CORNERS_MAX];         /* mean direction; 0 at a reversal */
    lanes state[RELAX_CORNERS_MAX];
    lanes_int spot[RELAX_CORNERS_MAX];
};

/*
 * What the rows of one axis count. A unit of a coordinate is near_per_unit parts of the tolerance,
 * and the two others are relative to that.
 */
struct relax_scale {
    lanes near_per_unit[SMOOTH_GROUPS_MAX];
    lanes unit_per_near[SMOOTH_GROUPS_MAX];
    float second_per_near[SMOOTH_GROUPS_MAX]; /* the same in all lanes, which so have one matrix */
    float third_per_near[SMOOTH_GROUPS_MAX];
    lanes second_most[SMOOTH_GROUPS_MAX]; /* the boxes, in those */
    lanes third_most[SMOOTH_GROUPS_MAX];
    float change; /* of the rate, in an interval (verifier.h) */
    float rounded;
};

/* Working memory; holds nothing between calls. */
struct relax {
    struct relax_scale scale;
    float band[4][SMOOTH_SAMPLES_MAX]; /* the matrix, by groups */
    relax_rows near;                   /* the curve at the samples: in the tube */
    relax_rows second;                 /* second differences: in the box of acceleration */
    relax_rows third;                  /* third differences: in the box of jerk */
    relax_rows step;
    relax_rows along;                      /* direction of the route at the closest points */
    lanes_int closest[SMOOTH_SAMPLES_MAX]; /* beside each sample on the route */
    float low[SMOOTH_SAMPLES_MAX], high[SMOOTH_SAMPLES_MAX]; /* as far as that is straight */
    float tube[SMOOTH_SAMPLES_MAX];                          /* how near it must be, 1 at most */
    struct relax_corners corners;
};

void takt_relax_window(struct relax *x, struct window *w, const struct route *r,
                       double tolerance_mm);

#endif
