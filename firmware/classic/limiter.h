/*
 * The source's limiter of axis velocities: a factor K on the feed (seed 003, section 3).
 *
 *     threshold   K = F_max / F above F_max                                              (10), its print turned over
 *     smooth      from F_max - d on; with x = (F - F_max + d) / 2d and k = x^2 - x^3/2
 *                 K = (F_max - d + (1 - k) 2d x) / F, from F_max + d on F_max / F          (13) to (16)
 *
 * F is what the axis's velocity would be without the limiter. k is 0 at x = 0 and 1/2 at x = 1, and
 * K F is twice continuously differentiable at both. Used in the cycle after the one it was found
 * in, as the source has it, K comes too late by what F rises in a cycle: velocities pass their
 * limits by about as much.
 */
#ifndef TAKT_CLASSIC_LIMITER_H
#define TAKT_CLASSIC_LIMITER_H

#include "base/point.h"

#include <stdint.h>

enum limiter_form {
    LIMITER_CEILING, /* none of these: the planner's feed ceiling */
    LIMITER_THRESHOLD,
    LIMITER_SMOOTH
};

/*
 * d in percent of F_max, of every axis on its own: 0 (the threshold form) to below 100, and where
 * nothing else is said.
 */
#define LIMITER_BAND_PERCENT_MAX 99
#define LIMITER_BAND_PERCENT     5

/*
 * K of one axis: its velocity without the limiter, >= 0, its highest one, > 0, and d in percent of
 * that.
 */
double takt_limiter_axis(enum limiter_form form, double velocity_mm_s, double most_mm_s,
                         uint8_t band_percent);

/* The least K of the axes (11). most_mm_s: of every axis; those that are 0 do not count. */
double takt_limiter_factor(enum limiter_form form, const struct point *velocity_mm_s,
                           const double most_mm_s[AXIS_COUNT],
                           const uint8_t band_percent[AXIS_COUNT]);

#endif
