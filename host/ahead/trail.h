/*
 * The trajectory of one section: a uniform cubic B-spline over time, and where along the path it is.
 *
 * Knots are step_s apart. Control points c_0 ... c_(n+2) belong to n intervals; with D the difference of neighbours,
 *
 *     |D c| <= V step, |D2 c| <= A step^2, |D3 c| <= J step^3
 *
 * bounds velocity, acceleration and jerk of the curve, and so every difference of setpoints taken from it.
 */
#ifndef TAKT_HOST_AHEAD_TRAIL_H
#define TAKT_HOST_AHEAD_TRAIL_H

#include <stdbool.h>
#include <stddef.h>

/* Control points that fix place, velocity and acceleration at an end. */
#define TRAIL_ENDS 3

struct trail {
    size_t intervals;
    double (*control)[3]; /* intervals + 3, mm; owned */
    double *place_mm;     /* along the path, at every half knot: 2 intervals + 1; owned */
    double *beyond;       /* of every interval, by excess_measure; owned */
};

/* False: out of memory. */
bool trail_allocate(struct trail *t, size_t intervals);
void trail_free(struct trail *t);

/* Weights of the four control points from floor(u) on, at the part 0 <= f <= 1 of an interval. */
void trail_weights(double f, double weight[4]);
/* The same for the first derivative by knots. */
void trail_slopes(double f, double weight[4]);

/* The sum of four control points with weights. */
void trail_sum(double (*control)[3], const double weight[4], double sum[3]);
/* The curve at knot u, 0 <= u <= intervals. */
void trail_at(const struct trail *t, double u, double point[3]);

#endif
