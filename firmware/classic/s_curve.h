/*
 * The S-curve of limited jerk from 0 to 1: its slope rises, stays and falls. Symmetric: the mean of
 * it is 1/2.
 */
#ifndef TAKT_CLASSIC_S_CURVE_H
#define TAKT_CLASSIC_S_CURVE_H

/* At u, 0 to 1; round: the part in which the slope rises, above 0 and at most 1/2. */
double takt_s_curve(double u, double round);

/* The integral from 0 to u. */
double takt_s_curve_integral(double u, double round);

/*
 * Shortest time for a change, >= 0, under limits of its slope and the slope's slope; *round of the
 * curve that does it.
 */
double takt_s_curve_time(double change, double slope, double second, double *round);

#endif
