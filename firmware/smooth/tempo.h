/*
 * How fast nominal time should pass along a window's curve as it is, so that it takes the least of it: b = r^2, the square of
 * the rate, a quadratic B-spline with its knots at the samples.
 *
 *     b(u) = sum of weight_k(f) energy[i + k], k = 0..2, for u = i + 1 + f: piece i of the window
 */
#ifndef TAKT_SMOOTH_TEMPO_H
#define TAKT_SMOOTH_TEMPO_H

#include "smooth/window.h"

/* One coefficient a piece, one before the first and one behind the last. */
#define TEMPO_MAX (SMOOTH_SAMPLES_MAX - 1)

/* Working memory; holds nothing between calls but energy. */
struct tempo {
    unsigned pieces;
    float energy[TEMPO_MAX];
    float most[TEMPO_MAX];    /* of it: velocity, programmed feed */
    float step[TEMPO_MAX];    /* of one iteration */
    float band[3][TEMPO_MAX]; /* its matrix: the diagonal, and what is beside it */
    float change;             /* of the rate, in an interval (judge.h) */
    float rounded;
    lanes bend_per_unit[SMOOTH_GROUPS_MAX]; /* differences in A and J */
    lanes twist_per_unit[SMOOTH_GROUPS_MAX];
    lanes twist_all[SMOOTH_GROUPS_MAX]; /* J, where the curve's part of it is less */
};

/* The best that is found. It begins as the window does, at rate 1; unless the path ends there, it ends so too. */
void tempo_find(struct tempo *p, const struct window *w, const struct route *r);
/* The same rate everywhere, but for so many pieces to both sides of one. */
void tempo_slow(struct tempo *p, const struct window *w, unsigned piece, unsigned around,
                float rate);
/* b at u samples from the first one, and its derivative. */
float tempo_energy(const struct tempo *p, float u, float *slope);

#endif
