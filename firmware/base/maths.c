/* The functions that run in the control cycle: few operations, at most one division. */
#include "maths.h"

#include "base/assert.h"
#include "bits.h"
#include "pair.h"

#include <stdint.h>

union bits_of_float {
    float value;
    uint32_t bits;
};

/* Floats that are not negative are in the order of their bits. */
float takt_maths_float_below(double x)
{
    union bits_of_float near = {.value = (float)x};

    if ((double)near.value > x)
        near.bits--;
    return near.value;
}

/* Below this an integer has 32 bits, which every processor converts faster than 64. */
#define SMALL_MAX 0x1p31

/* From 2^52 on every double is an integer. False for NaN. */
static bool may_have_fraction(double x)
{
    return maths_abs(x) < 0x1p52;
}

double takt_maths_floor(double x)
{
    if (!may_have_fraction(x))
        return x;
    double whole = (double)(int64_t)x;
    return whole > x ? whole - 1.0 : whole;
}

double takt_maths_ceil(double x)
{
    if (!may_have_fraction(x))
        return x;
    double whole = (double)(int64_t)x;
    return whole < x ? whole + 1.0 : whole;
}

double takt_maths_round(double x)
{
    if (!may_have_fraction(x))
        return x;
    double whole = maths_abs(x) < SMALL_MAX ? (double)(int32_t)x : (double)(int64_t)x;
    double rest = x - whole;
    if (rest >= 0.5)
        return whole + 1.0;
    return rest <= -0.5 ? whole - 1.0 : whole;
}

/*
 * An angle brought near zero: x = quadrant pi/2 + rest + tail, |rest| <= pi/4 (and a little more),
 * |tail| <= half an ulp of rest.
 */
struct reduced_angle {
    double rest_rad;
    double tail_rad;
    unsigned quadrant;
};

/*
 * pi/2 = PART_1 + PART_2 + PART_3: 35 bits each, so that their products with 17 bits are exact,
 * then 53 bits.
 */
#define HALF_PI_PART_1      0x1.921fb5444p+0
#define HALF_PI_PART_2      0x1.68c234c4cp-39
#define HALF_PI_PART_3      0x1.98a2e03707345p-77
#define TWO_OVER_PI         0.63661977236758138
#define ANGLE_EXACT_MAX_RAD 1e5

/*
 * Cody and Waite: rest = ((x - n P1) - n P2) - n P3, n the integer nearest to x / (pi/2). Up to 1e5
 * rad n has 16 bits: n P1, n P2 and the first difference are exact. The second one is exact when it
 * cancels, otherwise its rounding error goes to the tail.
 */
static struct reduced_angle reduce_angle(double x)
{
    double turns = x * TWO_OVER_PI;
    int32_t n = (int32_t)(turns < 0.0 ? turns - 0.5 : turns + 0.5);
    double first = x - n * HALF_PI_PART_1;
    struct pair second = pair_sum_ordered(first, -(n * HALF_PI_PART_2));
    struct pair rest = pair_sum_ordered(second.hi, second.lo - n * HALF_PI_PART_3);
    return (struct reduced_angle){rest.hi, rest.lo, (unsigned)n & 3U};
}

/*
 * x modulo the double nearest to 2 pi, for angles no machine turns by: it replaces x by an angle at
 * most half an ulp of x away. Long division in binary: at most 1022 steps up and down, every
 * subtraction exact.
 */
static double drop_whole_turns(double x)
{
    double rest = maths_abs(x);
    double turns = MATHS_TWO_PI;
    TAKT_ASSERT(maths_is_finite(x));
    while (turns * 2.0 <= rest)
        turns *= 2.0;
    while (turns >= MATHS_TWO_PI) {
        if (turns <= rest)
            rest -= turns;
        turns *= 0.5;
    }
    return x < 0.0 ? -rest : rest;
}

static struct reduced_angle reduce_any_angle(double x)
{
    if (maths_abs(x) <= ANGLE_EXACT_MAX_RAD)
        return reduce_angle(x);
    if (!maths_is_finite(x))
        return (struct reduced_angle){bits_nan(), 0.0, 0};
    return reduce_angle(drop_whole_turns(x));
}

/*
 * sin(r + t) = r + (r^3 S(r^2) + t (1 - r^2/2)), S minimax on |r| <= pi/4, relative error 2^-56.
 */
static double sine_near_zero(double r, double t)
{
    double z = r * r;
    double s = 1.589622724241663e-10;
    s = s * z - 2.5050747715280988e-08;
    s = s * z + 2.755731362110223e-06;
    s = s * z - 1.9841269829588793e-04;
    s = s * z + 8.333333333322118e-03;
    s = s * z - 1.6666666666666630e-01;
    return r + (r * z * s + t * (1.0 - 0.5 * z));
}

/*
 * cos(r + t) = 1 - r^2/2 + (r^4 C(r^2) - r t), C minimax on |r| <= pi/4, relative error 2^-59.
 * The rounding error of 1 - r^2/2 is carried along.
 */
static double cosine_near_zero(double r, double t)
{
    double z = r * r;
    double c = -1.1358534337833797e-11;
    c = c * z + 2.087570080054616e-09;
    c = c * z - 2.7557314178997113e-07;
    c = c * z + 2.4801587288850684e-05;
    c = c * z - 1.3888888888873056e-03;
    c = c * z + 4.1666666666666595e-02;
    struct pair lead = pair_sum_ordered(1.0, -0.5 * z);
    return lead.hi + (lead.lo + (z * z * c - r * t));
}

/* sin of the rest moved on by quadrant quarter turns: sin, cos, -sin, -cos. */
static double sine_in_quadrant(const struct reduced_angle *a, unsigned quadrant)
{
    double value = (quadrant & 1U) ? cosine_near_zero(a->rest_rad, a->tail_rad)
                                   : sine_near_zero(a->rest_rad, a->tail_rad);
    return (quadrant & 2U) ? -value : value;
}

void takt_maths_sincos(double x, double *sine, double *cosine)
{
    struct reduced_angle a = reduce_any_angle(x);
    double s = sine_near_zero(a.rest_rad, a.tail_rad);
    double c = cosine_near_zero(a.rest_rad, a.tail_rad);
    double across = (a.quadrant & 1U) ? c : s;
    double along = (a.quadrant & 1U) ? s : c;
    *sine = (a.quadrant & 2U) ? -across : across;
    *cosine = ((a.quadrant + 1U) & 2U) ? -along : along;
}

double takt_maths_sin(double x)
{
    struct reduced_angle a = reduce_any_angle(x);
    return sine_in_quadrant(&a, a.quadrant);
}

double takt_maths_cos(double x)
{
    struct reduced_angle a = reduce_any_angle(x);
    return sine_in_quadrant(&a, a.quadrant + 1U);
}

double takt_maths_tan(double x)
{
    double sine, cosine;
    takt_maths_sincos(x, &sine, &cosine);
    return sine / cosine;
}

/*
 * The angle of (x, y) is base +- atan u. The base is the direction nearest to (x, y) among those of
 * slope 0, 1/2 and 1 to one of the half axes; u = (small - c big) / (big + c small) is the slope to
 * it, at most 1/4.
 */
static const struct pair ATAN_BASE_RAD[4][3] = {
    /* around +x */
    {{0.0, 0.0},
     {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
     {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}},
    /* around +-y, x >= 0 */
    {{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54},
     {0x1.1b6e192ebbe44p+0, 0x1.b1b466a88828ep-54},
     {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}},
    /* around -x */
    {{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53},
     {0x1.56c6e7397f5aep+1, 0x1.660b64ece6f4bp-53},
     {0x1.2d97c7f3321d2p+1, 0x1.a79394c9e8a0ap-54}},
    /* around +-y, x < 0 */
    {{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54},
     {0x1.0468a8ace4df6p+1, 0x1.0620bf7406affp-55},
     {0x1.2d97c7f3321d2p+1, 0x1.a79394c9e8a0ap-54}},
};

/*
 * Slopes about halfway between the three directions. Not below 1/4: from there on small - big / 2
 * is exact.
 */
#define SLOPE_0_TO_HALF 0.25
#define SLOPE_HALF_TO_1 0.72

/* Below this slope atan u = u to the last bit, and the rest of the division could underflow. */
#define SLOPE_TINY 0x1p-60

/* u^3 A(u^2) = atan u - u, A minimax on |u| <= 1/4, relative error of atan 2^-57. */
static double atan_minus_argument(double u)
{
    double z = u * u;
    double a = 4.608689401668143e-02;
    a = a * z - 6.526016611375647e-02;
    a = a * z + 7.683749476653397e-02;
    a = a * z - 9.090604024138373e-02;
    a = a * z + 1.1111104743152794e-01;
    a = a * z - 1.4285714211974726e-01;
    a = a * z + 1.9999999999586363e-01;
    a = a * z - 3.333333333333254e-01;
    return u * z * a;
}

/* base[] +- atan(small / big), 0 <= small <= big. */
static double angle_from_bases(const struct pair *base, double sign, double small, double big)
{
    if (small < big * SLOPE_TINY)
        return base[0].hi + (base[0].lo + sign * (small / big));
    int nearest = small < big * SLOPE_0_TO_HALF ? 0 : small < big * SLOPE_HALF_TO_1 ? 1 : 2;
    double c = 0.5 * nearest;
    struct pair below = pair_sum_ordered(big, c * small);
    struct pair u = pair_quotient(small - c * big, below.hi, below.lo);
    double rest = u.lo + atan_minus_argument(u.hi + u.lo);
    struct pair lead = pair_sum_ordered(base[nearest].hi, sign * u.hi);
    return lead.hi + (lead.lo + (base[nearest].lo + sign * rest));
}

/* Scales vectors so long or short that 1/length would overflow or underflow, and only those. */
static double safe_scale(double longest)
{
    if (longest > 0x1p1000)
        return 0x1p-100;
    return longest < 0x1p-500 ? 0x1p500 : 1.0;
}

double takt_maths_atan2(double y, double x)
{
    double width = maths_abs(x);
    double height = maths_abs(y);
    bool steep = height > width;
    bool left = x < 0.0;
    double big = steep ? height : width;
    double small = steep ? width : height;
    if (small == 0.0 && big == 0.0)
        return 0.0;
    if (!(maths_is_finite(big) && maths_is_finite(small)))
        return bits_nan();
    double scale = safe_scale(big);
    double angle = angle_from_bases(ATAN_BASE_RAD[(left ? 2 : 0) + (steep ? 1 : 0)],
                                    steep != left ? -1.0 : 1.0, small * scale, big * scale);
    return y < 0.0 ? -angle : angle;
}

/*
 * f^(-1/3) for 1 <= f < 2: a minimax polynomial (2^-17), then one step of Newton for y^-3 = f
 * (2^-33): y + y (1 - f y^3) / 3.
 */
static double inverse_cbrt_1_to_2(double f)
{
    double y = -1.7018923440128935e-02;
    y = y * f + 1.5607077161222618e-01;
    y = y * f - 5.978705407033462e-01;
    y = y * f + 1.2437823329643665;
    y = y * f - 1.56602644959908;
    y = y * f + 1.7810570606011777;
    return y + y * (1.0 - f * (y * y * y)) * (1.0 / 3.0);
}

/*
 * Cube root of 1 <= m < 8, given y = m^(-1/3) to 2^-33. With t = the leading half of m y^2 and the
 * exact rest m - t^3 = 3 root^2 e - 3 root e^2 + ..., e = root - t: root = t + d + d^2 y + ...,
 * d = (m - t^3) y^2 / 3.
 */
static double cbrt_1_to_8(double m, double y)
{
    double t = pair_leading_half(m * y * y);
    double square = t * t;
    double square_lead = pair_leading_half(square);
    double rest = (m - square_lead * t) - (square - square_lead) * t;
    double d = rest * (y * y) * (1.0 / 3.0);
    return t + d * (1.0 + d * y);
}

/* Makes the exponent of any double, -1074 to 1023, positive; a multiple of 3. */
#define CBRT_EXPONENT_SHIFT 1077

double takt_maths_cbrt(double x)
{
    static const double CBRT_OF_INVERSE_POWER[3] = {1.0, 0.7937005259840998, 0.6299605249474366};
    double size = maths_abs(x);
    if (size == 0.0 || !maths_is_finite(x))
        return x;
    bool subnormal = size < DBL_MIN;
    uint64_t bits = bits_from_double(subnormal ? size * 0x1p54 : size);
    int exponent = bits_biased_exponent(bits) - BITS_EXPONENT_BIAS - (subnormal ? 54 : 0);
    double f = bits_to_double((bits & BITS_FRACTION) | bits_from_double(1.0));
    /* size = f 2^rest 2^(3 third), rest = 0, 1 or 2 */
    int rest = (exponent + CBRT_EXPONENT_SHIFT) % 3;
    int third = (exponent + CBRT_EXPONENT_SHIFT) / 3 - CBRT_EXPONENT_SHIFT / 3;
    double y = inverse_cbrt_1_to_2(f) * CBRT_OF_INVERSE_POWER[rest];
    double root = cbrt_1_to_8(f * bits_power_of_two(rest), y) * bits_power_of_two(third);
    return x < 0.0 ? -root : root;
}
