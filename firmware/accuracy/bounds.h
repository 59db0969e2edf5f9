/*
 * Error bounds of the ways to turn a planned feed into positions, and the words they need: what can
 * be said before anything moves. Source: seed 002, with the corrections named in README.md.
 */
#ifndef TAKT_ACCURACY_BOUNDS_H
#define TAKT_ACCURACY_BOUNDS_H

#include <stdint.h>

/* Unit steps */

/*
 * Farthest distance of a stepped line over n axes from the line, in steps of h: below sqrt(n - 1)
 * h.
 */
double takt_bounds_line_off_mm(unsigned axes, double step_mm);
/*
 * Highest speed of one axis, and of a path over n axes, of a drive that takes rate_hz steps a
 * second.
 */
double takt_bounds_axis_speed_mm_s(double step_mm, double rate_hz);
double takt_bounds_path_speed_mm_s(unsigned axes, double step_mm, double rate_hz);

/* Digital integration over one block */

struct bounds_cycles {
    double accelerating; /* cycles */
    double constant;
    double braking;
};

/* Cycles from rest to a speed: v / (a dt). */
double takt_bounds_ramp_cycles(double speed_mm_s, double acceleration_mm_s2, double cycle_s);

/*
 * Largest loss by truncation of an axis's velocity and acceleration words, in units of the last
 * place.
 */
double takt_bounds_truncation_ulp(const struct bounds_cycles *n);

/*
 * Bits behind the increment that keep a loss of ulps below one increment: the smallest k with
 * ulp < 2^k.
 */
unsigned takt_bounds_fraction_bits(double ulp);

/* Bits of a signed word for values up to that size. */
unsigned takt_bounds_word_bits(double largest);

/* Rotation of the radius vector */

/* Steps of at most angle_rad, turning by sweep_rad in all. */
double takt_bounds_rotation_along_mm(double radius_mm, double angle_rad, double sweep_rad);
double takt_bounds_rotation_growth_mm(double radius_mm, double angle_rad, double sweep_rad);
/* For a turn within an acceleration limit, whatever the radius: (pi/3) a dt^2. */
double takt_bounds_rotation_turn_mm(double acceleration_mm_s2, double cycle_s);

#endif
