/*
 * Values of several axes side by side, on which one operation works at once: a processor with
 * vector registers does them together, another one after the other, with the same bits. A vector
 * type of gcc and clang.
 */
#ifndef TAKT_SMOOTH_LANES_H
#define TAKT_SMOOTH_LANES_H

#include "base/point.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#define SMOOTH_LANES      4
#define SMOOTH_GROUPS_MAX ((AXIS_COUNT + SMOOTH_LANES - 1) / SMOOTH_LANES)
#define SMOOTH_SLOTS_MAX  (SMOOTH_GROUPS_MAX * SMOOTH_LANES)

typedef float lanes __attribute__((vector_size(4 * SMOOTH_LANES)));
typedef int32_t lanes_int __attribute__((vector_size(4 * SMOOTH_LANES)));

static inline lanes lanes_all(float x)
{
    return (lanes){x, x, x, x};
}

/* Values that follow each other in memory. */
static inline lanes lanes_at(const float *x)
{
    lanes at;

    memcpy(&at, x, sizeof at);
    return at;
}

static inline void lanes_put(float *at, lanes x)
{
    memcpy(at, &x, sizeof x);
}

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

static inline lanes lanes_sqrt(lanes x)
{
    return (lanes){__builtin_sqrtf(x[0]), __builtin_sqrtf(x[1]), __builtin_sqrtf(x[2]),
                   __builtin_sqrtf(x[3])};
}

static inline lanes lanes_size(lanes x)
{
    static const lanes_int size = {INT32_MAX, INT32_MAX, INT32_MAX, INT32_MAX};

    return (lanes)((lanes_int)x & size);
}

/* Is there a lane of a mask that is not zero? */
static inline bool lanes_any(lanes_int mask)
{
    return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
}

/* By lanes of mask, all ones or all zeros. */
static inline lanes lanes_choose(lanes_int mask, lanes yes, lanes no)
{
    return (lanes)(((lanes_int)yes & mask) | ((lanes_int)no & ~mask));
}

/* The larger and the smaller of each; b where one is NaN. */
static inline lanes lanes_max(lanes a, lanes b)
{
    return lanes_choose(a > b, a, b);
}

static inline lanes lanes_min(lanes a, lanes b)
{
    return lanes_choose(a < b, a, b);
}

/* Into -most ... most; NaN gives -most. */
static inline lanes lanes_clamp(lanes x, lanes most)
{
    return lanes_min(lanes_max(x, -most), most);
}

#endif
