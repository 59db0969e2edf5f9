/*
 * How fast nominal time should pass along a window's curve as it is, so that it takes the least of
 * it: b = r^2, the square of the rate, a quadratic B-spline with its knots at the samples.
 *
 *     b(u) = sum of weight_k(f) squared rate[i + k], k = 0..2, for u = i + 1 + f: piece i of the window
 */
#ifndef TAKT_SMOOTH_TEMPO_H
#define TAKT_SMOOTH_TEMPO_H

#include "smooth/window.h"

/*
 * One coefficient a piece, one before the first and one behind the last; and what fills the last
 * lanes.
 */
#define TEMPO_MAX (SMOOTH_SAMPLES_MAX + SMOOTH_LANES)

/* Samples of all slots; and what fills the last lanes. */
#define TEMPO_PLACES_MAX (SMOOTH_LANES * SMOOTH_SAMPLES_MAX + SMOOTH_LANES)

/*
 * What pieces need of an axis, at their start an acceleration, and a jerk there and at their end.
 */
#define TEMPO_ROWS 3

/* What rows add to three coefficients: a gradient of each, and products of each two. */
#define TEMPO_SUMS 9

/* How far needs are from their limits, and how far a step brings them there. */
struct tempo_approach {
    lanes room, size;
};

/*
 * Working memory; holds nothing between calls but squared rate. Lanes are pieces that follow each
 * other.
 */
struct tempo {
    unsigned pieces;
    unsigned capacity; /* samples of a slot */
    float rate_squared[TEMPO_MAX];
    float most[TEMPO_MAX];    /* of it: velocity, programmed feed */
    float step[TEMPO_MAX];    /* of one iteration */
    float band[3][TEMPO_MAX]; /* its matrix: the diagonal, and what is beside it */
    float change;             /* of the rate, in an interval (verifier.h) */
    float rounded;
    float second_per_unit[SMOOTH_SLOTS_MAX]; /* differences in A and J */
    float third_per_unit[SMOOTH_SLOTS_MAX];
    float third_all[SMOOTH_SLOTS_MAX]; /* J, where the curve's part of it is less */
    float first[TEMPO_PLACES_MAX]; /* differences where pieces begin, one slot after the other */
    float second[TEMPO_PLACES_MAX];
    float sum[TEMPO_SUMS][TEMPO_MAX]; /* of a piece's rows; the first piece is the third */
    struct tempo_approach approach[SMOOTH_SLOTS_MAX][TEMPO_ROWS];
};

/*
 * The best that is found. It begins as the window does, at rate 1; unless the path ends there, it
 * ends so too.
 */
void takt_tempo_find(struct tempo *p, const struct window *w, const struct route *r);
/* The same rate everywhere, but for this many pieces on both sides of one. */
void takt_tempo_slow(struct tempo *p, const struct window *w, unsigned piece, unsigned around,
                     float rate);
/* b at u samples from the first one, and its derivative. */
float takt_tempo_rate_squared(const struct tempo *p, float u, float *slope);

/* Rates between 0.15 and 1.5: what is farther off is left to the next window. */
#define RATE_SQUARED_MIN  0.0225f
#define RATE_SQUARED_MOST 2.25f

/*
 * Of p->pieces from the window's first sample on: differences, their limits, and the most that b
 * may be.
 */
void takt_tempo_begin(struct tempo *p, const struct window *w, const struct route *r);

#endif
