#include "accuracy/bounds.h"

#include "base/assert.h"
#include "base/maths.h"

double takt_bounds_line_off_mm(unsigned axes, double step_mm)
{
    TAKT_ASSERT(step_mm >= 0.0);
    return axes < 2 ? 0.0 : maths_sqrt((double)(axes - 1U)) * step_mm;
}

/* V_axis = h / T */
double takt_bounds_axis_speed_mm_s(double step_mm, double rate_hz)
{
    TAKT_ASSERT(step_mm >= 0.0 && rate_hz >= 0.0);
    return step_mm * rate_hz;
}

/* V_path = sqrt(n) h / T: all axes step at every tick */
double takt_bounds_path_speed_mm_s(unsigned axes, double step_mm, double rate_hz)
{
    return maths_sqrt((double)axes) * step_mm * rate_hz;
}

/* N = V / (a dt) */
double takt_bounds_ramp_cycles(double speed_mm_s, double acceleration_mm_s2, double cycle_s)
{
    TAKT_ASSERT(acceleration_mm_s2 > 0.0 && cycle_s > 0.0);
    return takt_maths_ceil(speed_mm_s / (acceleration_mm_s2 * cycle_s));
}

/* N_acc (N_acc + 1) / 2 + N_const + N_dec + N_dec (N_dec + 1) / 2 */
double takt_bounds_truncation_ulp(const struct bounds_cycles *n)
{
    TAKT_ASSERT(n->accelerating >= 0.0 && n->constant >= 0.0 && n->braking >= 0.0);
    const double up = 0.5 * n->accelerating * (n->accelerating + 1.0);
    const double down = n->braking + 0.5 * n->braking * (n->braking + 1.0);

    return up + n->constant + down;
}

static unsigned bits_above(double value)
{
    unsigned bits = 0;

    for (double power = 1.0; power <= value && bits < 1024U; power *= 2.0) {
        bits++;
    }
    return bits;
}

unsigned takt_bounds_fraction_bits(double ulp)
{
    return bits_above(ulp);
}

unsigned takt_bounds_word_bits(double largest)
{
    return 1U + bits_above(maths_abs(largest));
}

/* N R dphi^3 / 6 = R sweep dphi^2 / 6; over a turn pi R dphi^2 / 3 */
double takt_bounds_rotation_along_mm(double radius_mm, double angle_rad, double sweep_rad)
{
    TAKT_ASSERT(radius_mm >= 0.0);
    return radius_mm * maths_abs(sweep_rad) * angle_rad * angle_rad / 6.0;
}

/*
 * A step makes the radius longer by sqrt(1 + dphi^4 / 4), so N steps by
 * (1 + dphi^4 / 4)^(N/2) <= e^g, g = N dphi^4 / 8. R (e^g - 1) = R g (1 + g/2 + g^2/6 + ...), below
 * R g (1 + g) for g <= 1. The page's R g, pi R dphi^3 / 4 a turn, is the first term.
 */
double takt_bounds_rotation_growth_mm(double radius_mm, double angle_rad, double sweep_rad)
{
    TAKT_ASSERT(radius_mm >= 0.0 && angle_rad >= 0.0);
    const double g = maths_abs(sweep_rad) * angle_rad * angle_rad * angle_rad / 8.0;

    return radius_mm * (g <= 1.0 ? g * (1.0 + g) : takt_maths_exp(g) - 1.0);
}

/* pi R dphi^2 / 3 with R dphi^2 = V^2 dt^2 / R <= a dt^2 */
double takt_bounds_rotation_turn_mm(double acceleration_mm_s2, double cycle_s)
{
    TAKT_ASSERT(acceleration_mm_s2 >= 0.0);
    return MATHS_PI / 3.0 * acceleration_mm_s2 * cycle_s * cycle_s;
}
