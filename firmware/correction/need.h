/*
 * What correction takes of the axes' limits, at most: the share of velocity, acceleration and jerk
 * that the planner has to leave.
 */
#ifndef TAKT_CORRECTION_NEED_H
#define TAKT_CORRECTION_NEED_H

#include "base/point.h"

/* The most the commanded motion does: per axis, mm or rad. */
struct motion_bound {
    double velocity_mm_s[AXIS_COUNT];
    double acceleration_mm_s2[AXIS_COUNT];
    double jerk_mm_s3[AXIS_COUNT];
    double farthest_mm[AXIS_COUNT]; /* largest |position| */
};

struct need {
    double size_mm[AXIS_COUNT]; /* |K| */
    double velocity_mm_s[AXIS_COUNT];
    double acceleration_mm_s2[AXIS_COUNT];
    double jerk_mm_s3[AXIS_COUNT];
    double noise_mm[AXIS_COUNT]; /* rounding of K */
};

/* K of single precision, summed in a few steps, is rounded by this part of itself at most. */
#define NEED_ROUNDING (1.0 / 4194304.0)

/*
 * Adds what a correction K_i that depends on x_j through a slope takes:
 *
 *     dK/dt = s v    d2K/dt2 = s a    d3K/dt3 = s j
 */
void takt_need_add_slope(struct need *need, unsigned corrected, unsigned input, double slope,
                         const struct motion_bound *most);

/* Bounds of a quantity and of its first three derivatives in time. */
struct need_jet {
    double value[4];
};

/* The position of an axis is added to the quantity. */
void takt_need_jet_add_travel(struct need_jet *jet, const struct motion_bound *most, unsigned axis);

/* size cos(times x + ...), x the position of a rotary axis. */
struct need_jet takt_need_jet_wave(double size, double times, const struct motion_bound *most,
                                   unsigned axis);

/*
 * Adds a correction that is the product of two quantities (Leibniz): of third order r a3 + 3 r1
 * a2 + 3 r2 a1 + r3 a.
 */
void takt_need_add_product(struct need *need, unsigned corrected, const struct need_jet *r,
                           const struct need_jet *a);

#endif
