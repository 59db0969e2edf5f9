/*
 * Deterministic mathematics: the same bits on every processor and compiler.
 *
 * Built from IEEE-754 double + - * / and square root alone, never from libm, whose last bits differ
 * between libraries. Accuracy is stated per function in units of the last place (ulp) and proved by
 * tests/unit/test_base_maths.c. NaN in gives NaN out; the sign of a zero is not kept. Angles are
 * radians.
 */
#ifndef TAKT_BASE_MATHS_H
#define TAKT_BASE_MATHS_H

#include <stdbool.h>
#include <stdint.h>

#define MATHS_INFINITY (__builtin_inf())

#define MATHS_PI      3.14159265358979323846
#define MATHS_TWO_PI  6.28318530717958647692
#define MATHS_HALF_PI 1.57079632679489661923

/* Exact: correctly rounded by IEEE-754. x < 0 gives NaN. */
static inline double maths_sqrt(double x)
{
    return __builtin_sqrt(x);
}

static inline double maths_square(double x)
{
    return x * x;
}

static inline double maths_abs(double x)
{
    return __builtin_fabs(x);
}

static inline double maths_min(double a, double b)
{
    return a < b ? a : b;
}

static inline double maths_max(double a, double b)
{
    return a > b ? a : b;
}

static inline double maths_clamp(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

/* False for NaN and both infinities. */
static inline bool maths_is_finite(double x)
{
    return x - x == 0.0;
}

/* The largest number of single precision <= x, x >= 0. */
float takt_maths_float_below(double x);

/* Largest integer <= x and smallest integer >= x, as doubles; any |x|. Exact. */
double takt_maths_floor(double x);
double takt_maths_ceil(double x);
/* Nearest integer, halves away from zero (what part programs call ROUND). Exact. */
double takt_maths_round(double x);

/*
 * The same as an integer, |x| < 2^31 - 0.5: what is added is the last double below a half, so that
 * a half is rounded up to the next whole number by the sum itself and the last double below a half
 * is not. Nothing is asked of the fraction, which no processor could foresee.
 */
static inline int32_t maths_nearest(double x)
{
    const double below_half = 0.5 - 0x1p-54;

    return (int32_t)(x + (x < 0.0 ? -below_half : below_half));
}

/*
 * Sine and cosine of the same angle, |x| <= 1e5 rad within 1 ulp. A larger finite angle counts as
 * one at most an ulp of the angle away; an infinite one gives NaN. Tangent: within 2.5 ulp.
 */
void takt_maths_sincos(double x, double *sine, double *cosine);
double takt_maths_sin(double x);
double takt_maths_cos(double x);
double takt_maths_tan(double x);

/*
 * Angle of the vector (x, y) in (-pi, pi], within 1 ulp; (0, 0) gives 0, an infinite component NaN.
 */
double takt_maths_atan2(double y, double x);
/* -1 <= x <= 1, else NaN. Within 2 ulp. */
double takt_maths_asin(double x);
double takt_maths_acos(double x);

/* Cube root, any sign, within 1 ulp. */
double takt_maths_cbrt(double x);

/*
 * e^x, natural logarithm (x <= 0: NaN), and x^y for part-program expressions; within 2 ulp (power:
 * 4). power: x < 0 needs an integer y, else NaN; 0^0 = 1. Overflow gives infinity.
 */
double takt_maths_exp(double x);
double takt_maths_ln(double x);
double takt_maths_power(double x, double y);

#endif
