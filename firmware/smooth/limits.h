/*
 * What the smoother needs to know of a machine, and the sizes of its memory.
 */
#ifndef TAKT_SMOOTH_LIMITS_H
#define TAKT_SMOOTH_LIMITS_H

#include "smooth/lanes.h"

/*
 * Elements of the programmed path that are known at one time, and how many of them may be curved.
 */
#define SMOOTH_ELEMENTS_MAX 96
#define SMOOTH_CURVED_MAX   32

/* Coordinates of their starts: with more than three axes there are half as many elements. */
#define SMOOTH_COORDINATES_MAX (3 * SMOOTH_ELEMENTS_MAX)

/* What they may have in other than place, curve and feed, at one time: tools, offsets and so on. */
#define SMOOTH_MODES_MAX 4

/* Samples that are smoothed together; half as many where a machine has more axes than lanes. */
#define SMOOTH_SAMPLES_MAX 80

/* Pieces of the curve that lie before the trapezoidal reference while programs are read in time. */
#define SMOOTH_AHEAD_PIECES 256

/* Samples at each end of the window that stay where they are: a cubic piece has four. */
#define SMOOTH_FIXED 3

struct smooth_limits {
    unsigned axes; /* bit i set: the machine has axis i */
    double velocity_mm_s[AXIS_COUNT];
    double acceleration_mm_s2[AXIS_COUNT];
    double jerk_mm_s3[AXIS_COUNT];
    double chord_error_max_mm; /* of the exact path */
    double cycle_s;            /* control cycle */
    /* all windows of its ramp law together, as a multiple of the first one (plan/ramp_profile.h) */
    double windows;
};

/*
 * The tolerance is a distance over all axes, in which a degree counts like a millimetre: what one
 * unit of an axis (mm, rad) counts.
 */
#define SMOOTH_RAD_WEIGHT 57.29577951308232

static inline double smooth_weight(int axis)
{
    return axis < AXIS_LINEAR_COUNT ? 1.0 : SMOOTH_RAD_WEIGHT;
}

/*
 * What of a machine's limits is of use. Between -V and V an axis comes to sqrt(2 V J) at most,
 * rising and falling by J: what it could do beyond that is of no use, and nothing is to depend on
 * it.
 */
void takt_smooth_limit(struct smooth_limits *limits);

#endif
