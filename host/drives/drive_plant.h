/*
 * What a virtual drive moves, and how it controls it: a motor with a screw or gear, an encoder, and
 * the cascade of a position loop and a velocity loop.
 *
 * Lengths are mm for a linear axis, rad for a rotary one, as everywhere.
 */
#ifndef TAKT_DRIVES_DRIVE_PLANT_H
#define TAKT_DRIVES_DRIVE_PLANT_H

#include <stdbool.h>
#include <stdint.h>

#define DRIVE_PLANT_LOOP_PERIOD_MAX_US 1000

struct drive_plant_config {
    double travel_per_revolution_mm; /* of the axis, per turn of the motor: the screw's lead; > 0 */
    double inertia_kg_m2;            /* at the motor's shaft: rotor, screw and moved mass; > 0 */
    double viscous_friction_nm_s_per_rad;   /* torque per angular velocity of the motor; >= 0 */
    double torque_max_nm;                   /* either direction; > 0 */
    uint32_t encoder_counts_per_revolution; /* of the motor; 0: no quantisation */

    double position_gain_per_s;         /* velocity per position error (Kv); > 0 */
    double velocity_feed_forward_ratio; /* of the command's velocity; 0 ... 1 */
    double velocity_bandwidth_hz;       /* of the velocity loop's proportional part; > 0 */
    double velocity_integral_time_s;    /* of its integral part; 0: no integral part */

    uint32_t loop_period_us; /* of both loops and the integration; 1 ... 1000 */

    double following_error_window_mm;     /* object 6065: the drive faults beyond; 0: not watched */
    double quick_stop_deceleration_mm_s2; /* of quick stop and fault reaction (object 6085); > 0 */
};

struct drive_plant {
    struct drive_plant_config config;

    /* Derived from config once, in units of the axis. */
    double acceleration_max_mm_s2;
    double friction_per_s;
    double velocity_gain_per_s;
    double integral_gain_per_s2;
    double encoder_step_mm; /* 0: no quantisation */
    double encoder_steps_per_mm;
    double standstill_mm_s; /* slower than this the motor stands */

    /* The mechanics. */
    double position_mm;
    double velocity_mm_s;

    /* The controller. */
    double measured_mm;            /* what the encoder says now */
    double measured_velocity_mm_s; /* from its last two readings */
    double integral_mm_s2;
    double command_mm;            /* the position it is told to have now */
    double command_velocity_mm_s; /* of the last cycle */
};

/* A 400 W servo motor on a ball screw of 10 mm lead; see the room's README for the numbers. */
void drive_plant_set_default(struct drive_plant_config *config);

/*
 * NULL: every field of config is within its range, and the velocity loop is slow enough for its
 * period to be stable (2 pi bandwidth period <= 0.5). Else the name of the first field that is
 * wrong.
 */
const char *drive_plant_check(const struct drive_plant_config *config);

/* config has passed drive_plant_check. The plant stands still at position_mm, without torque. */
void drive_plant_init(struct drive_plant *plant, const struct drive_plant_config *config,
                      double position_mm);

/*
 * Cycles are cycle_ns long, > 0. A cycle is divided into equal steps, as few as are no longer than
 * loop_period_us.
 */

/*
 * One cycle with torque, in which the command moves from where it is to command_mm at a constant
 * velocity.
 */
void drive_plant_follow(struct drive_plant *plant, double command_mm, uint32_t cycle_ns);

/*
 * Before the first drive_plant_brake: from here the motor is to stop, whatever it was told before.
 */
void drive_plant_begin_brake(struct drive_plant *plant);

/*
 * One cycle of stopping: the command slows down by quick_stop_deceleration_mm_s2 and takes the
 * motor with it. True: the motor stands.
 */
bool drive_plant_brake(struct drive_plant *plant, uint32_t cycle_ns);

/* One cycle without torque: the motor runs out by its friction, the command stays with it. */
void drive_plant_coast(struct drive_plant *plant, uint32_t cycle_ns);

/* command - measured position. */
double drive_plant_following_error_mm(const struct drive_plant *plant);

#endif
