/*
 * What friction a motor has, as measured: torque over velocity, the same either way.
 */
#ifndef TAKT_SERVO_FRICTION_H
#define TAKT_SERVO_FRICTION_H

/* Points of the table: at rest, and at whole multiples of a velocity. */
#define FRICTION_POINTS 8

/*
 * Torques, or the accelerations that they make; behind the last point friction is what it is there.
 */
struct friction {
    double points_per_velocity; /* inverse of the velocity from point to point; >= 0 */
    double at[FRICTION_POINTS]; /* >= 0; all 0: none is known */
};

/*
 * What moves on at this velocity against friction; at 0 nothing does. Its sign is the velocity's.
 */
double takt_friction_at(const struct friction *friction, double velocity);

#endif
