/*
 * Cubic splines through given points: continuous with first and second derivative, so that an axis
 * that follows one has bounded jerk.
 */
#ifndef TAKT_CORRECTION_SPLINE_H
#define TAKT_CORRECTION_SPLINE_H

#define SPLINE_KNOTS_MAX 256

/*
 * Second derivatives at the knots of the spline through (knot, value). knot increases; count: 2 ...
 * SPLINE_KNOTS_MAX. At the ends the first two and the last two pieces are one cubic each ("not a
 * knot"); three points make a parabola, two a straight line.
 */
void takt_spline_second_derivatives(unsigned count, const double *knot, const double *value,
                                    double *second);

#endif
