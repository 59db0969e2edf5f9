/*
 * Values of several axes side by side, on which one operation works at once: a processor with vector registers does them
 * together, another one after the other, with the same bits. A vector type of gcc and clang.
 */
#ifndef TAKT_SMOOTH_LANES_H
#define TAKT_SMOOTH_LANES_H

#include "base/point.h"

#include <stdint.h>

#define SMOOTH_LANES      4
#define SMOOTH_GROUPS_MAX ((AXIS_COUNT + SMOOTH_LANES - 1) / SMOOTH_LANES)
#define SMOOTH_SLOTS_MAX  (SMOOTH_GROUPS_MAX * SMOOTH_LANES)

typedef float lanes __attribute__((vector_size(4 * SMOOTH_LANES)));
typedef int32_t lanes_int __attribute__((vector_size(4 * SMOOTH_LANES)));

static inline lanes lanes_of(lanes_int x)
{
    return __builtin_convertvector(x, lanes);
}

/* Towards zero; |x| < 2^31. */
static inline lanes_int lanes_int_of(lanes x)
{
    return __builtin_convertvector(x, lanes_int);
}

static inline float lanes_sum(lanes x)
{
    return (x[0] + x[1]) + (x[2] + x[3]);
}

static inline lanes lanes_size(lanes x)
{
    static const lanes_int size = {INT32_MAX, INT32_MAX, INT32_MAX, INT32_MAX};

    return (lanes)((lanes_int)x & size);
}

/* Into -most ... most; NaN gives -most. */
static inline lanes lanes_clamp(lanes x, lanes most)
{
    const lanes_int above_low = x > -most;
    const lanes high = (lanes)(((lanes_int)x & above_low) | ((lanes_int)-most & ~above_low));
    const lanes_int below_high = high < most;

    return (lanes)(((lanes_int)high & below_high) | ((lanes_int)most & ~below_high));
}

#endif
