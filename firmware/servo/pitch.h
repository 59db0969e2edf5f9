/*
 * The error of pitch of a drive's screw or gear: what is to be added to where the motor says the
 * axis is, at evenly spaced positions of the motor. Between them a cubic spline, so that an axis
 * that follows it has bounded jerk; beyond them the value of the end holds.
 */
#ifndef TAKT_SERVO_PITCH_H
#define TAKT_SERVO_PITCH_H

#include "servo/drive_objects.h"

#include <stdbool.h>

/*
 * The steepest that it may be. A loop that is closed behind it has its gains changed by as much, so
 * by a tenth at most; real screws are a hundred times better.
 */
#define PITCH_STEEPEST_RATIO 0.1

struct pitch {
    unsigned points; /* 2 ... DRIVE_PITCH_POINTS; 0: there is no error */
    double first_mm; /* where the motor is at the first point */
    double steps_per_mm;
    double value_mm[DRIVE_PITCH_POINTS];
    double second_mm[DRIVE_PITCH_POINTS]; /* second derivative, by steps */
};

/*
 * All but the second derivatives is set. False: it is steeper than PITCH_STEEPEST_RATIO anywhere,
 * or too short; it has no points then.
 */
bool takt_pitch_make(struct pitch *pitch);

/* x = y + K(y): what K is where the motor says y. */
double takt_pitch_at(const struct pitch *pitch, double motor_mm);

/* The y of an x. */
double takt_pitch_get_motor_mm(const struct pitch *pitch, double axis_mm);

#endif
