#include "decimal.h"

#include "base/assert.h"
#include "bits.h"

#include <stdbool.h>

/* 10^0 to 10^22: every power of ten that is a double without rounding. */
#define EXACT_POWER_MAX 22
static const double EXACT_POWER[EXACT_POWER_MAX + 1] = {
    1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
};

#define SMALL_POWER_MAX 9
static const uint32_t SMALL_POWER[SMALL_POWER_MAX + 1] = {
    1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000, 1000000000,
};

/*
 * Reading. A number is mantissa 10^exponent.
 */
struct scientific {
    uint64_t mantissa; /* the first 19 digits */
    int64_t exponent;
};

/* A mantissa below this has room for one more digit. */
#define MANTISSA_ROOM UINT64_C(1000000000000000000)

static size_t scan_number(const char *text, size_t length, struct scientific *number)
{
    size_t i = 0;
    bool after_point = false;
    bool has_digit = false;
    for (; i < length; i++) {
        unsigned digit = (unsigned)(unsigned char)text[i] - '0';
        if (text[i] == '.' && !after_point) {
            after_point = true;
            continue;
        }
        if (digit > 9)
            break;
        has_digit = true;
        bool taken = number->mantissa < MANTISSA_ROOM;
        if (taken)
            number->mantissa = number->mantissa * 10 + digit;
        number->exponent += (taken ? 0 : 1) - (after_point ? 1 : 0);
    }
    return has_digit ? i : 0;
}

/*
 * An unsigned integer of up to 40 limbs of 32 bits, the least significant first. inexact: a
 * division has left a remainder, the true value lies above by less than 1.
 */
#define WIDE_LIMBS 40

struct wide {
    uint32_t limb[WIDE_LIMBS];
    int count; /* limbs in use; the top one is not 0 */
    bool inexact;
};

/* mantissa 2^(32 zero_limbs), mantissa > 0 */
static void wide_set(struct wide *w, uint64_t mantissa, int zero_limbs)
{
    w->inexact = false;
    w->count = zero_limbs + (mantissa >> 32 != 0 ? 2 : 1);
    for (int i = 0; i < zero_limbs; i++)
        w->limb[i] = 0;
    w->limb[zero_limbs] = (uint32_t)mantissa;
    if (mantissa >> 32 != 0)
        w->limb[zero_limbs + 1] = (uint32_t)(mantissa >> 32);
}

static void wide_multiply(struct wide *w, uint32_t factor)
{
    uint64_t carry = 0;
    TAKT_ASSERT(w->count <= WIDE_LIMBS);
    for (int i = 0; i < w->count; i++) {
        carry += (uint64_t)w->limb[i] * factor;
        w->limb[i] = (uint32_t)carry;
        carry >>= 32;
    }
    if (carry != 0)
        w->limb[w->count++] = (uint32_t)carry;
}

static void wide_divide(struct wide *w, uint32_t divisor)
{
    uint64_t rest = 0;
    TAKT_ASSERT(divisor != 0);
    for (int i = w->count - 1; i >= 0; i--) {
        rest = rest << 32 | w->limb[i];
        w->limb[i] = (uint32_t)(rest / divisor);
        rest %= divisor;
    }
    w->inexact = w->inexact || rest != 0;
    while (w->count > 0 && w->limb[w->count - 1] == 0)
        w->count--;
}

/* Whole divisions may follow each other: floor(floor(a / b) / c) = floor(a / (b c)). */
static void wide_scale_by_ten(struct wide *w, int exponent)
{
    void (*scale)(struct wide *, uint32_t) = exponent < 0 ? wide_divide : wide_multiply;
    int steps = exponent < 0 ? -exponent : exponent;
    for (; steps > SMALL_POWER_MAX; steps -= SMALL_POWER_MAX)
        scale(w, SMALL_POWER[SMALL_POWER_MAX]);
    scale(w, SMALL_POWER[steps]);
}

static uint32_t wide_limb_from_top(const struct wide *w, int place)
{
    return place < w->count ? w->limb[w->count - 1 - place] : 0;
}

/*
 * The 64 leading bits, the first of them 1. *top_bit: the number of the first bit, 0 for 2^0.
 * *rest: whether anything stands behind them.
 */
static uint64_t wide_leading_bits(const struct wide *w, int *top_bit, bool *rest)
{
    uint64_t lead = (uint64_t)wide_limb_from_top(w, 0) << 32 | wide_limb_from_top(w, 1);
    uint64_t next = (uint64_t)wide_limb_from_top(w, 2) << 32;
    int zeros = __builtin_clzll(lead);
    TAKT_ASSERT(w->count > 0);
    *top_bit = 32 * w->count - 1 - zeros;
    *rest = w->inexact || (next << zeros) != 0;
    for (int place = 3; place < w->count; place++)
        *rest = *rest || wide_limb_from_top(w, place) != 0;
    return lead << zeros | (zeros > 0 ? next >> (64 - zeros) : 0);
}

/* w 2^exponent, rounded to nearest, ties to even; 0 below the normal doubles, infinity above. */
static double wide_to_double(const struct wide *w, int exponent)
{
    int top_bit;
    bool rest;
    uint64_t lead = wide_leading_bits(w, &top_bit, &rest);
    int biased = top_bit + exponent + BITS_EXPONENT_BIAS;
    if (biased < 1)
        return 0.0;
    if (biased >= BITS_EXPONENT_TOP)
        return bits_to_double(BITS_INFINITY);
    uint64_t kept = lead >> 11;
    uint64_t dropped = lead & 0x7ffU;
    bool up = dropped > 0x400U || (dropped == 0x400U && (rest || (kept & 1U) != 0));
    /* a carry out of the fraction raises the exponent, as it should */
    uint64_t fraction = kept - BITS_IMPLICIT_ONE + (up ? 1U : 0U);
    return bits_to_double(((uint64_t)biased << BITS_FRACTION_SIZE) + fraction);
}

/* mantissa < 10^19, so these exponents go beyond the range of double whatever the mantissa. */
#define EXPONENT_BELOW_ALL (-327)
#define EXPONENT_ABOVE_ALL 309

/* Exact integers all the way, one rounding at the end. */
static double read_exactly(uint64_t mantissa, int64_t exponent)
{
    if (exponent <= EXPONENT_BELOW_ALL)
        return 0.0;
    if (exponent >= EXPONENT_ABOVE_ALL)
        return bits_to_double(BITS_INFINITY);
    /* 10^n < 2^(10 n / 3 + 1): with two limbs more, a quotient keeps at least 64 bits */
    int zero_limbs = exponent < 0 ? 3 - 10 * (int)exponent / 96 : 0;
    struct wide w;
    wide_set(&w, mantissa, zero_limbs);
    wide_scale_by_ten(&w, (int)exponent);
    return wide_to_double(&w, -32 * zero_limbs);
}

/*
 * A mantissa and a power of ten that are both exact need one rounding, that of the division.
 * W. D. Clinger, "How to read floating point numbers accurately", 1990.
 */
static double scientific_to_double(const struct scientific *number)
{
    if (number->mantissa == 0)
        return 0.0;
    if (number->mantissa >> (BITS_FRACTION_SIZE + 1) != 0 || number->exponent < -EXACT_POWER_MAX ||
        number->exponent > EXACT_POWER_MAX)
        return read_exactly(number->mantissa, number->exponent);
    if (number->exponent < 0)
        return (double)number->mantissa / EXACT_POWER[-number->exponent];
    return (double)number->mantissa * EXACT_POWER[number->exponent];
}

size_t takt_decimal_read(const char *text, size_t length, double *value)
{
    struct scientific number = {0, 0};
    size_t taken = scan_number(text, length, &number);
    if (taken > 0)
        *value = scientific_to_double(&number);
    return taken;
}

/*
 * Writing. The size of a number below 2^30 = whole + fraction / 10^places.
 */
struct fixed {
    uint32_t whole;
    uint32_t fraction;
};

/* From here on numbers are written with an exponent. */
#define FIXED_LIMIT 1e9

/*
 * round(below 10^places / 2^shift), halves up, exactly; below < 2^53, below < 2^shift, shift >= 23.
 */
static uint32_t scale_fraction(uint64_t below, int shift, uint32_t power)
{
    uint64_t low = (below & 0xffffffffU) * power;
    uint64_t high = (below >> 32) * power + (low >> 32);
    /* the product is high 2^32 + (low mod 2^32), high < 2^52 */
    if (shift >= 32 + 64)
        return 0;
    if (shift > 32)
        return (uint32_t)((high + (UINT64_C(1) << (shift - 33))) >> (shift - 32));
    return (uint32_t)((high << (32 - shift)) +
                      (((low & 0xffffffffU) + (UINT64_C(1) << (shift - 1))) >> shift));
}

/* size = mantissa / 2^shift; the integer part is cut off, the fraction scaled and rounded. */
static struct fixed split_exactly(uint64_t size_bits, uint32_t power)
{
    int biased = bits_biased_exponent(size_bits);
    int shift = BITS_EXPONENT_BIAS + BITS_FRACTION_SIZE - biased;
    uint64_t mantissa = (size_bits & BITS_FRACTION) | (biased > 0 ? BITS_IMPLICIT_ONE : 0);
    uint64_t whole = shift <= BITS_FRACTION_SIZE ? mantissa >> shift : 0;
    uint64_t below = shift <= BITS_FRACTION_SIZE ? mantissa - (whole << shift) : mantissa;
    struct fixed f = {(uint32_t)whole, scale_fraction(below, shift, power)};
    if (f.fraction == power) {
        f.whole++;
        f.fraction = 0;
    }
    return f;
}

static const char PAIR_OF_DIGITS[] = "0001020304050607080910111213141516171819"
                                     "2021222324252627282930313233343536373839"
                                     "4041424344454647484950515253545556575859"
                                     "6061626364656667686970717273747576777879"
                                     "8081828384858687888990919293949596979899";

/* value with leading zeros in text[0 .. count). */
static void write_digits(char *text, uint32_t value, unsigned count)
{
    for (; count >= 2; count -= 2) {
        uint32_t rest = value / 100;
        size_t pair = value - 100 * rest;
        const char *two = PAIR_OF_DIGITS + 2 * pair;
        text[count - 2] = two[0];
        text[count - 1] = two[1];
        value = rest;
    }
    if (count == 1)
        text[0] = (char)('0' + value);
}

static unsigned count_digits(uint32_t value)
{
    unsigned count = 1;
    while (count <= SMALL_POWER_MAX && value >= SMALL_POWER[count])
        count++;
    return count;
}

static size_t write_fixed(char *text, double value, unsigned places)
{
    uint64_t bits = bits_from_double(value);
    struct fixed f = split_exactly(bits & ~BITS_SIGN, SMALL_POWER[places]);
    size_t length = 0;
    if ((bits & BITS_SIGN) != 0 && (f.whole | f.fraction) != 0)
        text[length++] = '-';
    unsigned whole_digits = count_digits(f.whole);
    write_digits(text + length, f.whole, whole_digits);
    length += whole_digits;
    if (places == 0)
        return length;
    text[length++] = '.';
    write_digits(text + length, f.fraction, places);
    return length + places;
}

static size_t write_name(char *text, const char *name)
{
    size_t length = 0;
    for (; name[length] != '\0'; length++)
        text[length] = name[length];
    return length;
}

/* 1.250e12: the size brought to 1 <= size < 10 that also rounds below 10. */
static size_t write_with_exponent(char *text, double value, unsigned places)
{
    double size = value < 0.0 ? -value : value;
    unsigned exponent = 0;
    for (; size >= EXACT_POWER[EXACT_POWER_MAX]; exponent += EXACT_POWER_MAX)
        size /= EXACT_POWER[EXACT_POWER_MAX];
    unsigned more = 0;
    while (size >= EXACT_POWER[more + 1])
        more++;
    size /= EXACT_POWER[more];
    exponent += more;
    if (size >= 10.0 - 0.5 / SMALL_POWER[places]) {
        size /= 10.0;
        exponent++;
    }
    size_t length = write_fixed(text, value < 0.0 ? -size : size, places);
    text[length++] = 'e';
    return length + write_fixed(text + length, exponent, 0);
}

size_t takt_decimal_write(char *text, double value, unsigned places)
{
    TAKT_ASSERT(places <= SMALL_POWER_MAX);
    if (value < FIXED_LIMIT && value > -FIXED_LIMIT)
        return write_fixed(text, value, places);
    if (value != value)
        return write_name(text, "nan");
    if (value - value != 0.0)
        return write_name(text, value < 0.0 ? "-inf" : "inf");
    return write_with_exponent(text, value, places);
}
