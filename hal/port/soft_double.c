/*
 * Addition, division, square root and comparison of doubles for a core whose unit is for single
 * precision alone. The compiler calls them by the names __aeabi_d... (Run-time ABI for the Arm
 * Architecture, 5.1.1). libgcc and the C library have them too, but they divide bit by bit
 * (README.md has the figures), and libgcc 12.2 subtracts wrongly: a power of two less a number 33
 * binary orders smaller is off by the last bit, one subtraction in some millions.
 *
 * Results are those of IEEE 754, rounded to nearest, ties to even, so they are the bits that a unit
 * for doubles gives (tests/target/target_arithmetic.py). What is infinite or no number, and for
 * division also 0 and subnormal numbers, is left to the library, whose functions the linker calls
 * __real_...
 *
 * Division and root work on integers, in digits of 27 bits. For 0 <= rest < divisor, both below
 * 2^53, and x slightly below 2^84 / divisor:
 *
 *     digit = rest/2^21 x / 2^36     rest' = 2^27 rest - digit divisor
 *
 * The digit is the right one or at most 2 too small, which subtracting the divisor once or twice
 * mends.
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

/* Doubled, so that the sign is gone: above this a number is none. */
#define INFINITE_DOUBLED 0xFFE0000000000000ULL
#define INFINITE         0x7FF0000000000000ULL
#define NO_NUMBER        0x7FF8000000000000ULL

/* Helpers of the compiler get and give doubles in integer registers. */
#define HELPER __attribute__((pcs("aapcs")))

HELPER double __real___aeabi_dadd(double a, double b);
HELPER double soft_double_add(double a, double b);
HELPER double __real___aeabi_ddiv(double a, double b);
HELPER double __wrap___aeabi_ddiv(double a, double b);
double sqrt(double value);
HELPER int __wrap___aeabi_dcmpeq(double a, double b);
HELPER int soft_double_is_less(double a, double b);
HELPER int soft_double_is_not_more(double a, double b);
HELPER int soft_double_is_not_less(double a, double b);
HELPER int soft_double_is_more(double a, double b);

static uint64_t bits_of(double value)
{
    uint64_t bits;

    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static double from_bits(uint64_t bits)
{
    double value;

    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint32_t exponent_of(uint64_t bits)
{
    return (uint32_t)(bits >> FRACTION_BITS) & EXPONENT_MASK;
}

/* Neither 0 or subnormal, nor infinite or none. */
static bool is_common(uint32_t exponent)
{
    return exponent - 1U < EXPONENT_MASK - 1U;
}

static uint32_t high_product(uint32_t a, uint32_t b)
{
    return (uint32_t)((uint64_t)a * b >> 32);
}

/* The result's bits; a fraction that rounding makes 2 carries into the exponent, as it should. */
static double pack(uint64_t sign, uint32_t exponent, uint64_t fraction)
{
    return from_bits(sign + ((uint64_t)(exponent - 1U) << FRACTION_BITS) + fraction);
}

/* -- addition -- */

/* A fraction with 10 bits below it: room to round by, and for a carry above. */
#define ROUND_BITS 10
#define ROUND_MASK 0x3FFU
#define ROUND_HALF 0x200U

/* For a number that is not infinite: its fraction, with the hidden bit unless it is subnormal. */
static uint64_t fraction_of(uint64_t bits)
{
    const uint64_t fraction = bits & FRACTION_MASK;

    return exponent_of(bits) != 0 ? fraction | HIDDEN_BIT : fraction;
}

/* Subnormal numbers have the exponent of the least others. */
static uint32_t scale_of(uint64_t bits)
{
    const uint32_t exponent = exponent_of(bits);

    return exponent != 0 ? exponent : 1U;
}

/* value / 2^by, its last bit set when anything was lost: that is all rounding must know of it. */
static uint64_t shift_down(uint64_t value, uint32_t by)
{
    if (by == 0)
        return value;
    if (by > 63U)
        return value != 0;
    return value >> by | (value << (64U - by) != 0);
}

/* The double nearest to fraction 2^-62 at this exponent; fraction is not 0. */
static double round_sum(uint64_t sign, uint32_t exponent, uint64_t fraction)
{
    const unsigned zeros = (unsigned)__builtin_clzll(fraction);
    uint32_t rest;

    if (zeros == 0) {
        fraction = shift_down(fraction, 1);
        exponent++;
    } else if (exponent >= zeros) {
        fraction <<= zeros - 1U;
        exponent -= zeros - 1U;
    } else {
        return from_bits(sign + (fraction << (exponent - 1U) >> ROUND_BITS)); /* subnormal, exact */
    }
    rest = (uint32_t)fraction & ROUND_MASK;
    fraction >>= ROUND_BITS;
    fraction += rest > ROUND_HALF || (rest == ROUND_HALF && (fraction & 1U) != 0);
    if (exponent >= EXPONENT_MASK)
        return from_bits(sign | (uint64_t)EXPONENT_MASK << FRACTION_BITS);
    return pack(sign, exponent, fraction);
}

/* |a| >= |b|, neither infinite: the smaller one is brought to the exponent of the larger. */
static double sum_of(uint64_t a, uint64_t b)
{
    const uint32_t exponent = scale_of(a);
    const uint64_t large = fraction_of(a) << ROUND_BITS;
    const uint64_t small = shift_down(fraction_of(b) << ROUND_BITS, exponent - scale_of(b));
    const uint64_t sum = ((a ^ b) & SIGN_BIT) != 0 ? large - small : large + small;

    if (sum == 0)
        return from_bits(a & b & SIGN_BIT); /* -0 only of two of them */
    return round_sum(a & SIGN_BIT, exponent, sum);
}

static bool is_finite(uint64_t bits)
{
    return exponent_of(bits) != EXPONENT_MASK;
}

HELPER double soft_double_add(double a, double b)
{
    const uint64_t a_bits = bits_of(a);
    const uint64_t b_bits = bits_of(b);

    if (!is_finite(a_bits) || !is_finite(b_bits))
        return __real___aeabi_dadd(a, b);
    return a_bits << 1 >= b_bits << 1 ? sum_of(a_bits, b_bits) : sum_of(b_bits, a_bits);
}

/* -- division -- */

/*
 * 2^63 / d for 2^31 <= d < 2^32, from below, with a relative error under 2^-27: 15 bits by the
 * core's divider, one step of Newton's x' = x + x (1 - x d), and 8 taken off, which is more than
 * truncation can have added.
 */
static uint32_t reciprocal(uint32_t d)
{
    const uint32_t x = (UINT32_MAX / ((d >> 16) + 1U)) << 15;
    const uint32_t missing = 0x80000000U - high_product(x, d);

    return x + (high_product(x, missing) << 1) - 8U;
}

/*
 * The next digit of rest / divisor; *rest becomes what is left, times 2^27. x: of the divisor's
 * upper 32 bits.
 */
static uint32_t next_digit(uint64_t *rest, uint64_t divisor, uint32_t x)
{
    uint32_t digit = high_product((uint32_t)(*rest >> 21), x) >> 4;

    *rest = (*rest << 27) - digit * divisor;
    while (*rest >= divisor) {
        *rest -= divisor;
        digit++;
    }
    return digit;
}

HELPER double __wrap___aeabi_ddiv(double a, double b)
{
    const uint64_t a_bits = bits_of(a);
    const uint64_t b_bits = bits_of(b);
    const uint32_t a_exponent = exponent_of(a_bits);
    const uint32_t b_exponent = exponent_of(b_bits);
    const uint64_t divisor = (b_bits & FRACTION_MASK) | HIDDEN_BIT;
    uint64_t rest = (a_bits & FRACTION_MASK) | HIDDEN_BIT;
    uint32_t exponent = a_exponent - b_exponent + BIAS;
    uint64_t quotient;
    uint32_t x;

    if (rest < divisor) {
        rest <<= 1;
        exponent--;
    }
    if (!is_common(a_exponent) || !is_common(b_exponent) || !is_common(exponent))
        return __real___aeabi_ddiv(a, b);
    rest -= divisor;
    x = reciprocal((uint32_t)(divisor >> 21));
    quotient = 1U << 27 | next_digit(&rest, divisor, x);
    quotient = quotient << 27 | next_digit(&rest, divisor, x);
    /* 55 bits: 53, and two to round by; a quotient of such numbers is never half-way */
    return pack((a_bits ^ b_bits) & SIGN_BIT, exponent, (quotient + 2U) >> 2);
}

/* -- square root -- */

/* floor(sqrt(m)) for 2^52 <= m < 2^54; *rest = m - its square. The unit gives 24 bits of it. */
static uint32_t root_digit(uint64_t m, uint64_t *rest)
{
    uint32_t root = (uint32_t)(__builtin_sqrtf((float)(uint32_t)(m >> 22)) * 2048.0F) - 12U;

    root += (uint32_t)((m - (uint64_t)root * root) >> 2) / (root >> 1);
    *rest = m - (uint64_t)root * root;
    while ((int64_t)*rest < 0) {
        root--;
        *rest += 2U * root + 1U;
    }
    while (*rest > 2U * root) {
        *rest -= 2U * root + 1U;
        root++;
    }
    return root;
}

/*
 * floor(2^27 sqrt(m)) from root r = floor(sqrt(m)) and rest = m - r^2: with the digit s
 *
 *     (2^27 r + s)^2 <= 2^54 m     =>     s about 2^27 rest / 2 r, what is left is 2^54 rest - 2^28 r s - s^2
 */
static uint64_t root_second(uint32_t r, uint64_t rest)
{
    const uint32_t x = reciprocal(r << 5);
    const uint32_t s = high_product((uint32_t)(rest << 4), x) >> 4;
    uint64_t root = ((uint64_t)r << 27) + s;
    int64_t left = (int64_t)((rest << 54) - ((uint64_t)r * s << 28) - (uint64_t)s * s);

    while (left < 0) {
        root--;
        left += (int64_t)(2U * root + 1U);
    }
    while (left > (int64_t)(2U * root)) {
        left -= (int64_t)(2U * root + 1U);
        root++;
    }
    return root;
}

/*
 * A common positive number is fraction 2^(exponent - BIAS - 52); root: root(fraction) 2^half, the
 * exponent even.
 */
static double common_root(uint64_t bits)
{
    const uint32_t exponent = exponent_of(bits);
    uint64_t fraction = (bits & FRACTION_MASK) | HIDDEN_BIT;
    uint64_t rest;
    uint32_t r;

    if ((exponent & 1U) == 0)
        fraction <<= 1;
    r = root_digit(fraction, &rest);
    /* 54 bits: 53, and one to round by; a root is never half-way */
    return pack(0, (exponent + BIAS) / 2U, (root_second(r, rest) + 1U) >> 1);
}

/* 0, subnormal, infinite, negative or no number. */
static double uncommon_root(uint64_t bits)
{
    static const double scale = 0x1p108, unscale = 0x1p-54;

    if (bits << 1 == 0 || bits << 1 > INFINITE_DOUBLED || bits == INFINITE)
        return from_bits(bits);
    if ((bits & SIGN_BIT) != 0)
        return from_bits(NO_NUMBER);
    return common_root(bits_of(from_bits(bits) * scale)) * unscale;
}

double sqrt(double value)
{
    const uint64_t bits = bits_of(value);
    const bool is_easy = (bits & SIGN_BIT) == 0 && is_common(exponent_of(bits));

    return is_easy ? common_root(bits) : uncommon_root(bits);
}

/* -- comparisons -- */

static bool is_number(uint64_t bits)
{
    return bits << 1 <= INFINITE_DOUBLED;
}

/* As a number that rises with the value: the magnitude, or its complement. Both zeros become 0. */
static int64_t rank(uint64_t bits)
{
    const int64_t magnitude = (int64_t)(bits & ~SIGN_BIT);

    return (int64_t)bits < 0 ? -magnitude : magnitude;
}

static bool is_less(uint64_t a, uint64_t b)
{
    return rank(a) < rank(b) && is_number(a) && is_number(b);
}

static bool is_not_above(uint64_t a, uint64_t b)
{
    return rank(a) <= rank(b) && is_number(a) && is_number(b);
}

HELPER int __wrap___aeabi_dcmpeq(double a, double b)
{
    return rank(bits_of(a)) == rank(bits_of(b)) && is_number(bits_of(a));
}

HELPER int soft_double_is_less(double a, double b)
{
    return is_less(bits_of(a), bits_of(b));
}

HELPER int soft_double_is_not_more(double a, double b)
{
    return is_not_above(bits_of(a), bits_of(b));
}

HELPER int soft_double_is_not_less(double a, double b)
{
    return is_not_above(bits_of(b), bits_of(a));
}

HELPER int soft_double_is_more(double a, double b)
{
    return is_less(bits_of(b), bits_of(a));
}
