/*
 * The trajectory of one section: a uniform cubic B-spline over time, and where along the path it
 * is.
 *
 * Knots are step_s apart. Control points c_0 ... c_(n+2) belong to n intervals; with D the
 * difference of neighbours,
 *
 *     |D c| <= V step, |D2 c| <= A step^2, |D3 c| <= J step^3
 *
 * bounds velocity, acceleration and jerk of the curve, and so every difference of setpoints taken
 * from it.
 *
 * On a machine whose axes have up to m modes the curve w is one of degree 3 + 2 m, with 2 m more
 * control points, from which those of the motors' and of the tool's cubic curves follow (modes.h).
 * On a stiff one all three are the same.
 */
#ifndef TAKT_HOST_AHEAD_TRAIL_H
#define TAKT_HOST_AHEAD_TRAIL_H

#include "ahead/modes.h"

#include <stdbool.h>
#include <stddef.h>

/* Control points that fix place, velocity and acceleration at an end of a cubic curve. */
#define TRAIL_ENDS 3

struct trail {
    size_t intervals;
    unsigned modes;
    double (*control)[3]; /* of w: intervals + trail_ends, mm; owned */
    double (*motor)[3];   /* intervals + 3, mm; owned if there are modes, else control */
    double (*tool)[3];    /* likewise */
    /*
     * The tool where the machine's modes are others (modes.h), if there are modes; and how the
     * first two points of it swing.
     */
    double (*stray[MODES_STRAYS])[3];
    double swing[MODES_STRAYS][2][3];
    size_t rest;      /* knots at its end in which all rests but stray tools */
    double *place_mm; /* along the path, at every half knot: 2 intervals + 1; owned */
    double *beyond;   /* of every interval, by excess_measure; owned */
};

/* Control points of w that fix what motors and tool do at an end, with so many modes. */
static inline size_t trail_ends(unsigned modes)
{
    return TRAIL_ENDS + 2 * (size_t)modes;
}

/* False: out of memory. */
bool trail_allocate(struct trail *t, size_t intervals, unsigned modes);
void trail_free(struct trail *t);

/*
 * A curve of a stiff machine's, from rest to rest, becomes one of these modes: it rests longer at
 * its ends. False: out of memory.
 */
bool trail_soften(struct trail *t, const struct ahead_modes *modes);

/* to is for intervals of from, from `first` on: it swings and rests as that does. */
void trail_continue(struct trail *to, const struct trail *from, size_t first, size_t intervals);

/* What motors and tool do when the curve is what it is. */
void trail_follow(struct trail *t, const struct ahead_modes *modes);

/* Weights of the four control points from floor(u) on, at the part 0 <= f <= 1 of an interval. */
void trail_weights(double f, double weight[4]);
/* The same of the 4 + 2 modes control points of w. */
void trail_curve_weights(unsigned modes, double f, double *weight);
/* The first for the first derivative by knots. */
void trail_slopes(double f, double weight[4]);

/* The sum of four control points with weights. */
void trail_sum(double (*control)[3], const double weight[4], double sum[3]);
/* The tool's curve or a stray tool's at knot u, 0 <= u <= intervals. */
void trail_at(const struct trail *t, double (*control)[3], double u, double point[3]);

#endif
