/*
 * Position and velocity loop of a drive, and how it brakes. What it moves is behind hal/motor.h.
 *
 * All in units of the axis, mm or rad. A cycle is divided into equal steps, as few as are no longer
 * than loop_period_us.
 */
#ifndef TAKT_SERVO_LOOP_H
#define TAKT_SERVO_LOOP_H

#include "hal/motor.h"
#include "servo/between.h"
#include "servo/friction.h"

#include <stdbool.h>
#include <stdint.h>

/*
 * Velocity gain times the loops' period: an inertia that follows its torque at once rings above 1,
 * and is unstable above 2; half of 1 leaves room for the rest.
 */
#define SERVO_LOOP_GAIN_STEP_MAX 0.5

/* What the loops know of the motor, and how they are tuned. */
struct servo_loop_config {
    double travel_per_revolution_mm; /* of the axis, per turn of the motor: the screw's lead; > 0 */
    double inertia_kg_m2;            /* at the motor's shaft; > 0 */
    double told_inertia_kg_m2;       /* what the loops take it for; 0: that */
    double torque_max_nm;            /* either direction; > 0 */
    double torque_rated_nm;          /* > 0 */
    uint32_t encoder_counts_per_revolution; /* of the motor; 0: no quantisation */
    uint32_t loop_period_us;                /* of both loops; > 0 */
    double position_gain_per_s;             /* velocity per position error (Kv); > 0 */
    double velocity_feed_forward_ratio;     /* of the command's velocity; 0 ... 1 */
    double velocity_bandwidth_hz;           /* of the velocity loop's proportional part; > 0 */
    double velocity_integral_time_s;        /* of its integral part; 0: no integral part */
    double torque_feed_forward_ratio;       /* of the command's acceleration; 0 ... 1 */
    struct friction
        friction_nm; /* over mm/s of the axis: what is fed forward of it; none: nothing */
};

struct servo_loop {
    struct servo_loop_config config;
    struct motor_port motor;

    /* Derived from config once, in units of the axis. */
    double acceleration_max_mm_s2;
    double velocity_gain_per_s; /* both by what they are told of the inertia */
    double integral_gain_per_s2;
    double torque_forward_ratio;
    double encoder_step_mm; /* 0: no quantisation */
    double encoder_steps_per_mm;
    double standstill_mm_s;    /* slower than this the motor stands */
    double mm_s2_per_rated;    /* acceleration by the rated torque */
    double rated_per_mm_s2;    /* its inverse */
    struct friction friction;  /* as acceleration over velocity */
    double torque_limit_mm_s2; /* acceleration by the torque it is allowed */

    /* How a cycle of cycle_ns is divided; made anew when another length of cycle comes. */
    uint32_t cycle_ns;
    uint32_t steps;
    double per_cycle_s, cycle_s;
    double step_s, per_step_s;

    struct motor_sense sense;      /* after the last cycle */
    double measured_mm;            /* what the encoder says now */
    double measured_velocity_mm_s; /* from its last two readings */
    double torque_mm_s2;           /* in the last step */
    double integral_mm_s2;
    double command_mm;            /* the position it is told to have now */
    double command_velocity_mm_s; /* of the last cycle */
    double brake_mm_s2;           /* of the stop that has begun */
    double velocity_offset_mm_s;  /* fed forward beside the command's (object 60B1) */
    double torque_offset_mm_s2;   /* the same for torque (object 60B2) */
};

/*
 * The command is where the encoder says the motor is. motor must stay usable as long as the loop.
 */
void takt_servo_loop_init(struct servo_loop *loop, const struct servo_loop_config *config,
                          const struct motor_port *motor);

/*
 * From now on it has gains, feed-forward and told inertia of config; motor and encoder stay as they
 * are.
 */
void takt_servo_loop_tune(struct servo_loop *loop, const struct servo_loop_config *config);

/* Between two cycles something about the motor has changed at once: it is looked at anew. */
void takt_servo_loop_look(struct servo_loop *loop);

/* Cycles are cycle_ns long, > 0. */

/*
 * One cycle with torque, in which the command moves from where it is to command_mm at a constant
 * velocity.
 */
void takt_servo_loop_follow(struct servo_loop *loop, double command_mm, uint32_t cycle_ns);

/*
 * The same along a piece of curve from where it is, over the part of the cycle; acceleration is fed
 * forward all along it.
 */
void takt_servo_loop_follow_piece(struct servo_loop *loop, const double piece[BETWEEN_COEFFICIENTS],
                                  double end_mm, uint32_t cycle_ns);

/* One cycle of the velocity loop alone: the command stays with the motor. */
void takt_servo_loop_turn(struct servo_loop *loop, double velocity_mm_s, uint32_t cycle_ns);

/*
 * One cycle with the torque for this acceleration, as far as there is so much; the command stays
 * with the motor.
 */
void takt_servo_loop_push(struct servo_loop *loop, double acceleration_mm_s2, uint32_t cycle_ns);

/* One cycle without torque: the command stays with the motor. */
void takt_servo_loop_coast(struct servo_loop *loop, uint32_t cycle_ns);

/*
 * Before the first takt_servo_loop_brake: from here the motor is to stop by deceleration_mm_s2 (>
 * 0), whatever it was told before.
 */
void takt_servo_loop_begin_brake(struct servo_loop *loop, double deceleration_mm_s2);

/*
 * One cycle of stopping: the command slows down and takes the motor with it. True: the motor
 * stands.
 */
bool takt_servo_loop_brake(struct servo_loop *loop, uint32_t cycle_ns);

/* The motor stands at something: the command comes back to it, and nothing pushes any more. */
void takt_servo_loop_let_go(struct servo_loop *loop);

/* Acceleration by all the torque that it has, has left, and is allowed. */
double takt_servo_loop_torque_limit_mm_s2(const struct servo_loop *loop);

/* command - measured position. */
double takt_servo_loop_following_error_mm(const struct servo_loop *loop);

/* Torque of the motor by its rated torque. */
double takt_servo_loop_torque_ratio(const struct servo_loop *loop);

#endif
