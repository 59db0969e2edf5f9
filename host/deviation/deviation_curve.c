#include "deviation/deviation_curve.h"

#include "base/maths.h"

#define DEGREE   (MATHS_PI / 180.0)
#define MM_PER_M 1e3

/* In um or urad, as the numbers are. */
static double evaluate(const double n[DEVIATION_CURVE_NUMBERS], double x_mm, double min_mm,
                       double max_mm)
{
    const double s = (2.0 * x_mm - min_mm - max_mm) / (max_mm - min_mm);
    double e = n[DEVIATION_LINEAR_PER_M] * x_mm / MM_PER_M + n[DEVIATION_BOW] * s * s;

    if (n[DEVIATION_WAVELENGTH_MM] > 0.0) {
        e += n[DEVIATION_SINE] * takt_maths_sin(MATHS_TWO_PI * x_mm / n[DEVIATION_WAVELENGTH_MM] +
                                                n[DEVIATION_PHASE_DEG] * DEGREE);
    }
    return e;
}

double deviation_curve(const double numbers[DEVIATION_CURVE_NUMBERS], double x_mm, double min_mm,
                       double max_mm)
{
    return (evaluate(numbers, x_mm, min_mm, max_mm) - evaluate(numbers, 0.0, min_mm, max_mm));
}
