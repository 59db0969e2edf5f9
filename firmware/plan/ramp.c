/*
 * The ramp by D = |to - from|:
 *
 *      a ^    ____                  with constant acceleration   D >= a^2/j:  T = D/a + a/j
 *        |   /    \                 triangular                   D <  a^2/j:  T = 2 sqrt(D/j)
 *        |  /      \
 *        +-+--------+--> t          length = (from + to) / 2 * T, since the law is symmetric
 */
#include "plan/ramp.h"

#include "base/maths.h"

double ramp_duration(double delta_mm_s, const struct ramp_limits *limits)
{
    const double a = limits->a_mm_s2;
    const double j = limits->j_mm_s3;

    if (delta_mm_s * j >= a * a) {
        return delta_mm_s / a + a / j;
    }
    return 2.0 * maths_sqrt(delta_mm_s / j);
}

double ramp_length(double from_mm_s, double to_mm_s, const struct ramp_limits *limits)
{
    return 0.5 * (from_mm_s + to_mm_s) * ramp_duration(maths_abs(to_mm_s - from_mm_s), limits);
}

/*
 * Triangular: L = (2 v + D) sqrt(D/j). With x = sqrt(D): x^3 + 2 v x = L sqrt(j), one real root. Cardano's
 * x = u - p/u, u = cbrt(q + sqrt(q^2 + p^3)), p = 2v/3, q = L sqrt(j)/2 cancels when p is large, so two Newton steps
 * on the convex left side restore the digits.
 */
static double reach_triangular(double v, double length_mm, double j)
{
    const double right = length_mm * maths_sqrt(j);
    const double p = 2.0 * v / 3.0;
    const double q = 0.5 * right;
    const double u = maths_cbrt(q + maths_sqrt(q * q + p * p * p));
    double x = u - p / u;

    for (int i = 0; i < 2; i++) {
        x -= (x * (x * x + 2.0 * v) - right) / (3.0 * x * x + 2.0 * v);
    }
    return v + x * x;
}

/*
 * With constant acceleration: L = (2 v + D)/2 (D/a + a/j), a quadratic in D:
 * D^2 + 2 B D = 2 a (L - v a/j), B = v + a^2/(2j).
 */
static double reach_trapezoidal(double v, double length_mm, double a, double j)
{
    const double b = v + a * a / (2.0 * j);
    const double c = 2.0 * a * (length_mm - v * a / j);

    return v + c / (b + maths_sqrt(b * b + c));
}

double ramp_reach(double low_mm_s, double length_mm, const struct ramp_limits *limits)
{
    const double a = limits->a_mm_s2;
    const double j = limits->j_mm_s3;
    const double full = a * a / j; /* smallest change of feed with constant acceleration */

    if (length_mm <= 0.0) {
        return low_mm_s;
    }
    if (length_mm >= (2.0 * low_mm_s + full) * a / j) {
        return reach_trapezoidal(low_mm_s, length_mm, a, j);
    }
    return reach_triangular(low_mm_s, length_mm, j);
}

double ramp_append(struct profile *p, double s_mm, double from_mm_s, double to_mm_s,
                   const struct ramp_limits *limits)
{
    const double delta = maths_abs(to_mm_s - from_mm_s);
    const double sign = to_mm_s > from_mm_s ? 1.0 : -1.0;
    const double j = limits->j_mm_s3;
    const double rise_s = maths_min(maths_sqrt(delta / j), limits->a_mm_s2 / j);

    if (delta == 0.0) {
        return s_mm;
    }
    const double flat_s = maths_max(0.0, ramp_duration(delta, limits) - 2.0 * rise_s);
    const double peak = sign * j * rise_s;
    struct profile_state at = {s_mm, from_mm_s, 0.0};

    at = profile_append(p, at, rise_s, sign * j);
    at.a_mm_s2 = peak;
    if (flat_s > 0.0) {
        at = profile_append(p, at, flat_s, 0.0);
    }
    at = profile_append(p, at, rise_s, -sign * j);
    return at.s_mm;
}
