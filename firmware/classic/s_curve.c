#include "classic/s_curve.h"

#include "base/assert.h"
#include "base/maths.h"

/* The first half: with height h = 1/(1 - r) of the slope, h u^2/(2r), then h (u - r/2). */
static double first_half(double u, double round)
{
    const double height = 1.0 / (1.0 - round);

    TAKT_ASSERT(round > 0.0 && round <= 0.5 && u >= 0.0);
    return u < round ? height * u * u / (2.0 * round) : height * (u - 0.5 * round);
}

double takt_s_curve(double u, double round)
{
    return u <= 0.5 ? first_half(u, round) : 1.0 - first_half(1.0 - u, round);
}

/* h u^3/(6r), then h (u^2/2 - r u/2 + r^2/6). */
static double first_half_integral(double u, double round)
{
    const double height = 1.0 / (1.0 - round);

    TAKT_ASSERT(round > 0.0 && round <= 0.5 && u >= 0.0);
    if (u < round) {
        return height * u * u * u / (6.0 * round);
    }
    return height * (0.5 * u * (u - round) + round * round / 6.0);
}

double takt_s_curve_integral(double u, double round)
{
    return u <= 0.5 ? first_half_integral(u, round) : u - 0.5 + first_half_integral(1.0 - u, round);
}

/* T = D/a + a/j where the slope a is reached, D >= a^2/j; else 2 sqrt(D/j). */
double takt_s_curve_time(double change, double slope, double second, double *round)
{
    TAKT_ASSERT(slope > 0.0 && second > 0.0);
    *round = 0.5;
    if (change * second < slope * slope) {
        return 2.0 * maths_sqrt(change / second);
    }
    const double time = change / slope + slope / second;

    *round = slope / second / time;
    return time;
}
