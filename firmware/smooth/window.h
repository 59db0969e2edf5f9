/*
 * The samples being smoothed: control points of a uniform cubic B-spline, one every interval of nominal time.
 *
 *     q(u) = sum of b_k(f) x[i + k], k = 0..3, for u = i + 1 + f: the piece i lies between samples i + 1 and i + 2
 *
 * at_mm tells where on the route the curve is beside each sample. The first SMOOTH_FIXED samples are kept for good, the
 * last ones as well while they are in the window.
 */
#ifndef TAKT_SMOOTH_WINDOW_H
#define TAKT_SMOOTH_WINDOW_H

#include "smooth/route.h"

#include <stdbool.h>

struct window {
    unsigned count;
    bool at_end; /* its last samples are the end of the route, where the path comes to rest */
    double interval_s;
    double at_mm[SMOOTH_SAMPLES_MAX];
    uint32_t element[SMOOTH_SAMPLES_MAX]; /* of the route, at at_mm */
    double x[AXIS_COUNT][SMOOTH_SAMPLES_MAX];
};

/* Weights of four neighbours at fraction f of a piece; first derivative by f. */
void window_weights(double f, double weight[4]);

/* Begins at rest at the start of the route. */
void window_start(struct window *w, const struct route *r);
/* Begins anew at rest where the curve has come to: at the end of its first three samples. */
void window_rest(struct window *w);
/* Appends samples at the nominal feed until the window is full or the route's end is in it. */
void window_extend(struct window *w, const struct route *r);
/* Drops the oldest samples. */
void window_drop(struct window *w, unsigned count);
/* The curve at fraction f of the piece that begins with sample i, and where that is on the route. */
void window_point(const struct window *w, unsigned i, double f, struct point *p);
double window_at(const struct window *w, unsigned i, double f);
/* Finds every sample's place on the route anew, from the curve beside it. */
void window_locate(struct window *w, const struct route *r);

/* How far a sample may be from where it was thought to be, along the route. */
void window_reach(const struct window *w, unsigned i, double *from_mm, double *to_mm);

#endif
