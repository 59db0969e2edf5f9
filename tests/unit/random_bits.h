/* Random numbers of all exponents, the same everywhere: for tests of the room base. */
#ifndef TAKT_TESTS_RANDOM_BITS_H
#define TAKT_TESTS_RANDOM_BITS_H

#include "base/maths.h"
#include "unity.h"

#include <math.h>
#include <stdint.h>

#define RANDOM_COUNT 200000
#define NOT_A_NUMBER ((double)NAN)

void setUp(void)
{
}

void tearDown(void)
{
}

/* SplitMix64 (G. Steele, D. Lea, C. Flood, 2014): the same numbers everywhere. */
static inline uint64_t random_bits(uint64_t *state)
{
    uint64_t z = (*state += UINT64_C(0x9e3779b97f4a7c15));
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

static inline double random_between(uint64_t *state, double low, double high)
{
    return low + (high - low) * ((double)(random_bits(state) >> 11) * 0x1p-53);
}

/* Any finite double, all exponents alike. */
static inline double random_finite(uint64_t *state)
{
    union {
        uint64_t bits;
        double value;
    } any;
    do
        any.bits = random_bits(state);
    while (!maths_is_finite(any.value));
    return any.value;
}

#endif
