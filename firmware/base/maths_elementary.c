/* The functions of part-program expressions: not fast, but right to the last bit but one. */
#include "maths.h"

#include "bits.h"
#include "pair.h"

/* ln 2 in two parts: the first has 42 bits, so that its product with an exponent is exact. */
#define LN_2_PART_1   0x1.62e42fefa3p-1
#define LN_2_PART_2   0x1.3de6af278ece6p-42
#define ONE_OVER_LN_2 1.4426950408889634

/* Beyond these e^x is infinite or 0. */
#define EXP_ARGUMENT_MAX 800.0

/* a + b without error, any order. D. E. Knuth, The Art of Computer Programming, volume 2, 4.2.2. */
static struct pair sum_any_order(double a, double b)
{
    double sum = a + b;
    double b_part = sum - a;
    return (struct pair){sum, (a - (sum - b_part)) + (b - b_part)};
}

static struct pair pair_add(struct pair a, struct pair b)
{
    struct pair sum = sum_any_order(a.hi, b.hi);
    return pair_sum_ordered(sum.hi, sum.lo + (a.lo + b.lo));
}

static struct pair pair_multiply(struct pair a, struct pair b)
{
    double product = a.hi * b.hi;
    double a_lead = pair_leading_half(a.hi);
    double a_rest = a.hi - a_lead;
    double b_lead = pair_leading_half(b.hi);
    double b_rest = b.hi - b_lead;
    double error =
        ((a_lead * b_lead - product) + a_lead * b_rest + a_rest * b_lead) + a_rest * b_rest;
    return pair_sum_ordered(product, error + (a.hi * b.lo + a.lo * b.hi));
}

/* value 2^exponent, in two factors because 2^exponent alone may be out of range. */
static double scale_by_power_of_two(double value, int exponent)
{
    int half = exponent / 2;
    return value * bits_power_of_two(half) * bits_power_of_two(exponent - half);
}

/* (e^r - 1 - r) / r^2 = 1/2! + r/3! + r^2/4! + ..., |r| <= ln 2 / 2, to 2^-57 of e^r. */
static double exp_series(double r)
{
    double sum = 1.0 / 6227020800.0;
    sum = sum * r + 1.0 / 479001600.0;
    sum = sum * r + 1.0 / 39916800.0;
    sum = sum * r + 1.0 / 3628800.0;
    sum = sum * r + 1.0 / 362880.0;
    sum = sum * r + 1.0 / 40320.0;
    sum = sum * r + 1.0 / 5040.0;
    sum = sum * r + 1.0 / 720.0;
    sum = sum * r + 1.0 / 120.0;
    sum = sum * r + 1.0 / 24.0;
    sum = sum * r + 1.0 / 6.0;
    return sum * r + 0.5;
}

/* e^x = 2^k e^r, r = x - k ln 2, k the integer nearest to x / ln 2. */
static double exp_of_pair(struct pair x)
{
    if (maths_abs(x.hi) > EXP_ARGUMENT_MAX)
        x = (struct pair){x.hi < 0.0 ? -EXP_ARGUMENT_MAX : EXP_ARGUMENT_MAX, 0.0};
    double k = takt_maths_round(x.hi * ONE_OVER_LN_2);
    struct pair r = sum_any_order(x.hi - k * LN_2_PART_1, x.lo - k * LN_2_PART_2);
    struct pair one_plus_r = pair_sum_ordered(1.0, r.hi);
    double rest = one_plus_r.lo + (r.lo + r.hi * r.hi * exp_series(r.hi));
    return scale_by_power_of_two(one_plus_r.hi + rest, (int)k);
}

/*
 * (ln((1 + s)/(1 - s)) - 2 s - 2/3 s^3) / s^5 = 2/5 + 2/7 s^2 + ..., z = s^2, |s| <= 3 - 2 sqrt 2.
 */
static double ln_series(double z)
{
    double sum = 2.0 / 23.0;
    sum = sum * z + 2.0 / 21.0;
    sum = sum * z + 2.0 / 19.0;
    sum = sum * z + 2.0 / 17.0;
    sum = sum * z + 2.0 / 15.0;
    sum = sum * z + 2.0 / 13.0;
    sum = sum * z + 2.0 / 11.0;
    sum = sum * z + 2.0 / 9.0;
    sum = sum * z + 2.0 / 7.0;
    return sum * z + 2.0 / 5.0;
}

/*
 * ln m = 2 s + 2/3 s^3 + 2/5 s^5 + ..., s = (m - 1) / (m + 1), for 1/sqrt 2 <= m <= sqrt 2, to
 * 2^-65.
 */
static struct pair ln_near_one(double m)
{
    static const struct pair TWO_THIRDS = {0x1.5555555555555p-1, 0x1.5555555555555p-55};
    struct pair below = sum_any_order(m, 1.0);
    struct pair s = pair_quotient(m - 1.0, below.hi, below.lo);
    s = pair_sum_ordered(s.hi, s.lo);
    struct pair cube = pair_multiply(pair_multiply(s, s), s);
    struct pair third_order = pair_multiply(cube, TWO_THIRDS);
    double z = s.hi * s.hi;
    third_order.lo += cube.hi * z * ln_series(z);
    return pair_add((struct pair){2.0 * s.hi, 2.0 * s.lo}, third_order);
}

/* ln x = k ln 2 + ln m, x = 2^k m, 1/sqrt 2 <= m < sqrt 2; x positive and finite. */
static struct pair ln_pair(double x)
{
    bool subnormal = x < DBL_MIN;
    uint64_t bits = bits_from_double(subnormal ? x * 0x1p54 : x);
    int exponent = bits_biased_exponent(bits) - BITS_EXPONENT_BIAS - (subnormal ? 54 : 0);
    double m = bits_to_double((bits & BITS_FRACTION) | bits_from_double(1.0));
    if (m >= 1.4142135623730951) {
        m *= 0.5;
        exponent++;
    }
    struct pair whole = pair_sum_ordered(exponent * LN_2_PART_1, exponent * LN_2_PART_2);
    return pair_add(whole, ln_near_one(m));
}

double takt_maths_exp(double x)
{
    if (x != x)
        return x;
    return exp_of_pair((struct pair){x, 0.0});
}

double takt_maths_ln(double x)
{
    if (!(x > 0.0))
        return bits_nan();
    if (!maths_is_finite(x))
        return x;
    struct pair ln = ln_pair(x);
    return ln.hi + ln.lo;
}

/* size^y = e^(y ln size), size >= 0. */
static double power_of_size(double size, double y)
{
    /* ln size is 0 or at least 2^-53, so a larger y overflows or underflows all the same */
    static const double EXPONENT_MAX = 0x1p64;
    if (size == 0.0 || !maths_is_finite(size))
        return (size == 0.0) == (y > 0.0) ? 0.0 : MATHS_INFINITY;
    y = maths_clamp(y, -EXPONENT_MAX, EXPONENT_MAX);
    return exp_of_pair(pair_multiply(ln_pair(size), (struct pair){y, 0.0}));
}

double takt_maths_power(double x, double y)
{
    if (x != x || y != y)
        return bits_nan();
    if (y == 0.0)
        return 1.0;
    if (x >= 0.0)
        return power_of_size(x, y);
    if (takt_maths_floor(y) != y)
        return bits_nan();
    bool odd = takt_maths_floor(0.5 * y) != 0.5 * y;
    double size = power_of_size(-x, y);
    return odd ? -size : size;
}

/* sqrt(1 - x^2) = sqrt((1 - x)(1 + x)), the product without loss of digits near 1. */
static double sine_from_cosine(double x)
{
    struct pair product = pair_multiply(sum_any_order(1.0, -x), sum_any_order(1.0, x));
    return maths_sqrt(product.hi);
}

/* asin x = angle of the vector (sqrt(1 - x^2), x). */
double takt_maths_asin(double x)
{
    if (!(maths_abs(x) <= 1.0))
        return bits_nan();
    return takt_maths_atan2(x, sine_from_cosine(x));
}

/* acos x = angle of the vector (x, sqrt(1 - x^2)). */
double takt_maths_acos(double x)
{
    if (!(maths_abs(x) <= 1.0))
        return bits_nan();
    return takt_maths_atan2(sine_from_cosine(x), x);
}
