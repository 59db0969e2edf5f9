/*
 * What a drive takes back of its mechanics: a motor port on a motor port. What stands above it, the
 * loops, homing and probes, sees the axis instead of the motor.
 *
 *     y = encoder - play      x = y + K(y - origin)
 *
 * K is the error of pitch, in force once the axis is homed. play is half the backlash, ahead of the
 * axis in the direction in which it was told to go last; at a reversal it fades from one side to
 * the other.
 */
#ifndef TAKT_SERVO_COMPENSATION_H
#define TAKT_SERVO_COMPENSATION_H

#include "correction/fade.h"
#include "hal/motor.h"
#include "servo/pitch.h"

#include <stdbool.h>

struct compensation {
    struct motor_port motor;
    double encoder_mm; /* what it said last */
    bool is_homed;
    double origin_mm; /* y at position 0 */
    struct pitch pitch;

    double backlash_mm;
    double slack_mm;  /* of what it has been told to go: 0 at a low end of it, ... */
    double direction; /* 1 up, -1 down, 0: it has not moved yet */
    struct fade play_mm;
    double followed_mm; /* the play, when it was told last */
    struct fade_pace pace;
};

/* Nothing is taken back yet. motor: must stay usable as long as this; NULL: there is none. */
void takt_compensation_init(struct compensation *compensation, const struct motor_port *motor);

/* The play is so wide from now on, wherever it is: while nobody follows what the motor says. */
void takt_compensation_set_backlash(struct compensation *compensation, double backlash_mm);

/* The port on it. compensation must stay where it is. */
struct motor_port takt_compensation_get_port(struct compensation *compensation);

/* What its encoder says now, where the axis is. */
double takt_compensation_get_axis_mm(const struct compensation *compensation);

/* How the axis has been told to go in a cycle, and how a reversal is made of it. */
struct compensation_way {
    double way_mm;             /* of the axis; or as far as it went, where it is told a torque */
    double resolution_mm;      /* a way back of less is no reversal; > 0 */
    double acceleration_mm_s2; /* of the motor on its way through the play, at most */
    double step_s;             /* from one turn of the motor to the next */
};

void takt_compensation_follow(struct compensation *compensation,
                              const struct compensation_way *way);

#endif
