/*
 * Smooths the samples of a window inside the tolerance, at fixed timing (README.md).
 */
#ifndef TAKT_SMOOTH_RELAX_H
#define TAKT_SMOOTH_RELAX_H

#include "smooth/window.h"

/* Corners of the route in a window: sharper ones are looked at one by one. */
#define RELAX_CORNERS_MAX SMOOTH_ELEMENTS_MAX

/* One kind of condition: what it should be, and how far it has been from that, summed up. */
struct relax_rows {
    double goal[AXIS_COUNT][SMOOTH_SAMPLES_MAX];
    double sum[AXIS_COUNT][SMOOTH_SAMPLES_MAX];
};

struct relax_corner {
    unsigned piece; /* in which the curve passes it */
    double weight[4];
    uint32_t element;   /* that begins at it */
    struct point along; /* mean direction; 0 at a reversal */
    struct point goal;
    struct point sum;
};

struct relax_bands {
    double d0[SMOOTH_SAMPLES_MAX];
    double d1[SMOOTH_SAMPLES_MAX];
    double d2[SMOOTH_SAMPLES_MAX];
    double d3[SMOOTH_SAMPLES_MAX];
};

/* Working memory; holds nothing between calls. */
struct relax {
    struct relax_rows near;  /* the curve at the samples: in the tube */
    struct relax_rows bend;  /* second differences: in the box of acceleration */
    struct relax_rows twist; /* third differences: in the box of jerk */
    struct relax_corner corner[RELAX_CORNERS_MAX];
    unsigned corners;
    struct relax_bands bands[AXIS_COUNT];
    double step[AXIS_COUNT][SMOOTH_SAMPLES_MAX];
    double weight_near, weight_bend[AXIS_COUNT], weight_twist[AXIS_COUNT];
};

void relax_window(struct relax *x, struct window *w, const struct route *r, double tolerance_mm,
                  unsigned iterations);

#endif
