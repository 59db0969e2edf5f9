/*
 * What the optimiser keeps: the limits of the linear axes, the times between knots and between
 * setpoints, and the modes.
 */
#ifndef TAKT_HOST_AHEAD_LIMITS_H
#define TAKT_HOST_AHEAD_LIMITS_H

#include "ahead/modes.h"

/*
 * Where the modes are others than told, as far as they may be, the tool may be so many tolerances
 * off the path.
 */
#define STRAY_TOLERANCES 3

struct ahead_limits {
    double velocity_mm_s[3];
    double acceleration_mm_s2[3];
    double jerk_mm_s3[3];
    double step_s;            /* between knots of the curve */
    double cycle_s;           /* between setpoints */
    struct ahead_modes modes; /* between motors and tool */
};

#endif
