/*
 * Single precision: what the smoother works with on differences, where 24 bits are enough and a
 * microcontroller has a unit for it. + - * / and square root alone, so the bits are the same
 * everywhere.
 */
#ifndef TAKT_SMOOTH_SINGLE_H
#define TAKT_SMOOTH_SINGLE_H

#include "base/maths.h"

#define SINGLE_INFINITY (__builtin_inff())

static inline float single_sqrt(float x)
{
    return __builtin_sqrtf(x);
}

static inline float single_abs(float x)
{
    return __builtin_fabsf(x);
}

static inline float single_min(float a, float b)
{
    return a < b ? a : b;
}

static inline float single_max(float a, float b)
{
    return a > b ? a : b;
}

/* NaN gives low. */
static inline float single_clamp(float x, float low, float high)
{
    return x > low ? x < high ? x : high : low;
}

/* The nearest integer, halves away from zero; |x| < 2^31. */
static inline int single_round(float x)
{
    return (int)(x < 0.0f ? x - 0.5f : x + 0.5f);
}

/*
 * Cube root of 1e-15 <= x <= 1e15 but for some 1e-6 of it; of 0, or less than that, too large at
 * most.
 */
float takt_single_cbrt(float x);

#endif
