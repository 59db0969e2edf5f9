/*
 * The 64 bits of a double (IEEE-754 binary64: sign, 11 bits exponent with bias 1023, 52 bits
 * fraction). Private to this room.
 */
#ifndef TAKT_BASE_BITS_H
#define TAKT_BASE_BITS_H

#include <float.h>
#include <stdint.h>

_Static_assert(FLT_EVAL_METHOD == 0, "every double operation must round to double");
_Static_assert(DBL_MANT_DIG == 53 && sizeof(double) == 8, "double must be IEEE-754 binary64");

#define BITS_SIGN          UINT64_C(0x8000000000000000)
#define BITS_FRACTION      UINT64_C(0x000fffffffffffff)
#define BITS_IMPLICIT_ONE  UINT64_C(0x0010000000000000)
#define BITS_NAN           UINT64_C(0x7ff8000000000000)
#define BITS_INFINITY      UINT64_C(0x7ff0000000000000)
#define BITS_FRACTION_SIZE 52
#define BITS_EXPONENT_BIAS 1023
#define BITS_EXPONENT_TOP  0x7ff

union bits_of_double {
    double value;
    uint64_t bits;
};

static inline uint64_t bits_from_double(double value)
{
    return (union bits_of_double){.value = value}.bits;
}

static inline double bits_to_double(uint64_t bits)
{
    return (union bits_of_double){.bits = bits}.value;
}

/* The exponent field, 0 to 2047. */
static inline int bits_biased_exponent(uint64_t bits)
{
    return (int)((bits >> BITS_FRACTION_SIZE) & BITS_EXPONENT_TOP);
}

/* 2^exponent, -1022 <= exponent <= 1023. */
static inline double bits_power_of_two(int exponent)
{
    return bits_to_double((uint64_t)(exponent + BITS_EXPONENT_BIAS) << BITS_FRACTION_SIZE);
}

/* The same NaN everywhere: the sign of a NaN that an operation makes differs between processors. */
static inline double bits_nan(void)
{
    return bits_to_double(BITS_NAN);
}

#endif
