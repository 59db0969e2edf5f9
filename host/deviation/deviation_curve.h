/*
 * How one error of a machine depends on the position of one axis.
 */
#ifndef TAKT_DEVIATION_DEVIATION_CURVE_H
#define TAKT_DEVIATION_DEVIATION_CURVE_H

/*
 * e(x) = linear x + bow ((x - middle) / half)^2 + sine sin(2 pi x / wavelength + phase), less its
 * value at 0: machine zero is where the machine was set up. Units as in a machine file: um and
 * um/m, or urad and urad/m.
 */
enum {
    DEVIATION_LINEAR_PER_M,
    DEVIATION_BOW,
    DEVIATION_SINE,
    DEVIATION_WAVELENGTH_MM, /* 0: no sine */
    DEVIATION_PHASE_DEG,
    DEVIATION_CURVE_NUMBERS
};

/* For an axis that goes from min to max; in mm or rad. */
double deviation_curve(const double numbers[DEVIATION_CURVE_NUMBERS], double x_mm, double min_mm,
                       double max_mm);

#endif
