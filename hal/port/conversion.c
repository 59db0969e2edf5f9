/*
 * Between doubles and 64-bit integers, for which no Cortex-M has an instruction. libgcc makes them
 * of additions and multiplications of doubles; here they are a shift and a rounding. The same
 * values, by the same rules: to a double rounded to nearest, ties to even; to an integer towards
 * zero. What no integer holds is left to libgcc.
 */
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#define FRACTION_BITS 52
#define FRACTION_MASK 0xFFFFFFFFFFFFFULL
#define HIDDEN_BIT    0x10000000000000ULL
#define EXPONENT_MASK 0x7FFU
#define BIAS          1023
#define SIGN_BIT      0x8000000000000000ULL

/* Bits of a 64-bit number that do not fit into a double, and half of the last one that does. */
#define ROUNDED_BITS 11
#define ROUNDED_MASK 0x7FFU
#define HALF         0x400U

#define HELPER __attribute__((pcs("aapcs")))

HELPER double __wrap___aeabi_l2d(int64_t value);
HELPER double __wrap___aeabi_ul2d(uint64_t value);
HELPER int64_t __wrap___aeabi_d2lz(double value);
HELPER uint64_t __wrap___aeabi_d2ulz(double value);
HELPER int64_t __real___aeabi_d2lz(double value);
HELPER uint64_t __real___aeabi_d2ulz(double value);

static double pack(uint64_t sign, uint64_t magnitude)
{
    uint64_t bits = 0;
    double value;

    if (magnitude != 0) {
        const unsigned shift = (unsigned)__builtin_clzll(magnitude);
        const uint64_t full = magnitude << shift;
        const uint32_t rest = (uint32_t)full & ROUNDED_MASK;
        const uint64_t fraction = full >> ROUNDED_BITS;

        bits = sign + ((uint64_t)(BIAS + 62U - shift) << FRACTION_BITS) + fraction +
               (rest > HALF || (rest == HALF && (fraction & 1U) != 0));
    }
    memcpy(&value, &bits, sizeof value);
    return value;
}

HELPER double __wrap___aeabi_l2d(int64_t value)
{
    return value < 0 ? pack(SIGN_BIT, 0U - (uint64_t)value) : pack(0, (uint64_t)value);
}

HELPER double __wrap___aeabi_ul2d(uint64_t value)
{
    return pack(0, value);
}

/* The whole part of a magnitude below 2^63. False: it is not. */
static bool unpack(uint64_t bits, uint64_t *whole)
{
    const uint32_t exponent = (uint32_t)(bits >> FRACTION_BITS) & EXPONENT_MASK;
    const uint64_t fraction = (bits & FRACTION_MASK) | HIDDEN_BIT;

    if (exponent < BIAS)
        *whole = 0;
    else if (exponent <= BIAS + FRACTION_BITS)
        *whole = fraction >> (BIAS + FRACTION_BITS - exponent);
    else
        *whole = fraction << ((exponent - BIAS - FRACTION_BITS) & 63U);
    return exponent < BIAS + 63U;
}

HELPER int64_t __wrap___aeabi_d2lz(double value)
{
    uint64_t bits, whole;

    memcpy(&bits, &value, sizeof bits);
    if (!unpack(bits, &whole))
        return __real___aeabi_d2lz(value);
    return (bits & SIGN_BIT) != 0 ? -(int64_t)whole : (int64_t)whole;
}

HELPER uint64_t __wrap___aeabi_d2ulz(double value)
{
    uint64_t bits, whole;

    memcpy(&bits, &value, sizeof bits);
    if ((bits & SIGN_BIT) != 0 || !unpack(bits, &whole))
        return __real___aeabi_d2ulz(value);
    return whole;
}
