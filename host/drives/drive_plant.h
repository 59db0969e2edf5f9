/*
 * What a virtual drive moves, and how it controls it: a motor with a screw or gear, an encoder, and
 * the cascade of a position loop and a velocity loop.
 *
 * Lengths are mm for a linear axis, rad for a rotary one, as everywhere. The motor's position, in
 * units of the axis, is what the encoder counts; the table stands elsewhere by backlash and the
 * screw's error of pitch.
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
    double coulomb_friction_nm;             /* against any motion; >= 0 */
    double torque_max_nm;                   /* either direction; > 0 */
    double torque_rated_nm;                 /* what the motor can give for good; > 0 */
    uint32_t encoder_counts_per_revolution; /* of the motor; 0: no quantisation */

    double position_gain_per_s;         /* velocity per position error (Kv); > 0 */
    double velocity_feed_forward_ratio; /* of the command's velocity; 0 ... 1 */
    double velocity_bandwidth_hz;       /* of the velocity loop's proportional part; > 0 */
    double velocity_integral_time_s;    /* of its integral part; 0: no integral part */

    double torque_feed_forward_ratio; /* of the command's acceleration; 0 ... 1 */

    uint32_t loop_period_us; /* of both loops and the integration; 1 ... 1000 */

    double backlash_mm;           /* play between motor and table; >= 0 */
    double pitch_error_mm;        /* amplitude of the screw's error; >= 0 */
    double pitch_error_period_mm; /* of its sine; > 0 */

    double ambient_temperature_c; /* also of the motor at power-on */
    double temperature_rise_k;    /* of the motor at its rated torque, after long; >= 0 */
    double temperature_time_s;    /* time constant of the motor's temperature; > 0 */
    double temperature_max_c;     /* the drive faults beyond (EMCY 4310); 0: not watched */

    double start_mm;           /* where the table stands at power-on, on the axis */
    uint32_t absolute_encoder; /* 1: it knows its position at power-on; 0: it counts from 0 there */
    double limit_switch_min_mm; /* switches on the axis: active at or below, */
    double limit_switch_max_mm; /* at or above */
    double home_switch_mm;      /* active at or above */
    double
        home_switch_length_mm; /* up to so much above; 0: without an end. If the motor turns the other way: below */
    double hard_stop_min_mm; /* the motor comes no farther */
    double hard_stop_max_mm;

    double following_error_window_mm;     /* object 6065: the drive faults beyond; 0: not watched */
    uint32_t following_error_timeout_ms;  /* object 6066: for longer than this */
    double quick_stop_deceleration_mm_s2; /* of quick stop and fault reaction (object 6085); > 0 */
};

/* What scripted faults have made of the plant. */
struct drive_plant_damage {
    bool is_jammed;      /* the axis does not move */
    double torque_ratio; /* part of the torque the motor still has, 0 ... 1 */
};

struct drive_plant {
    struct drive_plant_config config;

    /* Derived from config once, in units of the axis. */
    double acceleration_max_mm_s2;
    double friction_per_s;
    double coulomb_mm_s2;
    double velocity_gain_per_s;
    double integral_gain_per_s2;
    double encoder_step_mm; /* 0: no quantisation */
    double encoder_steps_per_mm;
    double standstill_mm_s;    /* slower than this the motor stands */
    double mm_s2_per_rated;    /* acceleration by the rated torque */
    double rated_per_mm_s2;    /* its inverse */
    double torque_limit_mm_s2; /* acceleration by the torque it is allowed */
    double temperature_per_s;

    /* How a cycle of cycle_ns is divided; made anew when another length of cycle comes. */
    uint32_t cycle_ns;
    uint32_t steps;
    double cycle_s, per_cycle_s; /* and the inverse */
    double step_s, per_step_s;

    /* The mechanics. */
    double position_mm; /* of the motor */
    double velocity_mm_s;
    double acceleration_mm_s2; /* by the motor's torque, in the last step */
    double encoder_shift_mm;   /* the encoder reads this much more than the motor's position */
    double encoder_rounder;    /* rounds to steps and adds the shift */
    double play_mm; /* the table is behind the motor by this, half the backlash at most */
    double temperature_c;
    struct drive_plant_damage damage;

    /* The controller. */
    double measured_mm;            /* what the encoder says now */
    double measured_velocity_mm_s; /* from its last two readings */
    double integral_mm_s2;
    double command_mm;            /* the position it is told to have now */
    double command_velocity_mm_s; /* of the last cycle */
    double brake_mm_s2;           /* of the stop that has begun */
    double velocity_offset_mm_s;  /* fed forward beside the command's (object 60B1) */
    double torque_offset_mm_s2;   /* the same for torque (object 60B2) */
};

/* A 400 W servo motor on a ball screw of 10 mm lead; see the room's README for the numbers. */
void drive_plant_set_default(struct drive_plant_config *config);

/*
 * NULL: every field of config is within its range, and the velocity loop is slow enough for its
 * period to be stable (2 pi bandwidth period <= 0.5). Else the name of the first field that is
 * wrong.
 */
const char *drive_plant_check(const struct drive_plant_config *config);

/* config has passed drive_plant_check. The plant stands still at start_mm, without torque. */
void drive_plant_init(struct drive_plant *plant, const struct drive_plant_config *config);

/*
 * Cycles are cycle_ns long, > 0. A cycle is divided into equal steps, as few as are no longer than
 * loop_period_us.
 */

/*
 * One cycle with torque, in which the command moves from where it is to command_mm at a constant
 * velocity.
 */
void drive_plant_follow(struct drive_plant *plant, double command_mm, uint32_t cycle_ns);

/* One cycle of the velocity loop alone: the command stays with the motor. */
void drive_plant_turn(struct drive_plant *plant, double velocity_mm_s, uint32_t cycle_ns);

/* One cycle with the torque for this acceleration, as far as there is so much; the command stays with the motor. */
void drive_plant_push(struct drive_plant *plant, double acceleration_mm_s2, uint32_t cycle_ns);

/* Acceleration by all the torque that it has, has left, and is allowed. */
double drive_plant_torque_limit_mm_s2(const struct drive_plant *plant);

/*
 * Before the first drive_plant_brake: from here the motor is to stop by deceleration_mm_s2 (> 0),
 * whatever it was told before.
 */
void drive_plant_begin_brake(struct drive_plant *plant, double deceleration_mm_s2);

/*
 * One cycle of stopping: the command slows down and takes the motor with it. True: the motor
 * stands.
 */
bool drive_plant_brake(struct drive_plant *plant, uint32_t cycle_ns);

/* One cycle without torque: the motor runs out by its friction, the command stays with it. */
void drive_plant_coast(struct drive_plant *plant, uint32_t cycle_ns);

/* command - measured position. */
double drive_plant_following_error_mm(const struct drive_plant *plant);

/* Where the table stands on the axis: the motor's position, the play in it and the error of pitch. */
double drive_plant_table_mm(const struct drive_plant *plant);

/* Torque of the motor by its rated torque. */
double drive_plant_torque_ratio(const struct drive_plant *plant);

/* The encoder reads by_mm more from now on, though nothing has moved. */
void drive_plant_shift_encoder(struct drive_plant *plant, double by_mm);

#endif
