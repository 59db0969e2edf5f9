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

#include "hal/motor.h"
#include "servo/loop.h"

#include <stdbool.h>
#include <stdint.h>

#define DRIVE_PLANT_LOOP_PERIOD_MAX_US 1000
#define DRIVE_PLANT_DELAY_MAX          64 /* steps; a power of two */

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

    double friction_forward_nm
        [FRICTION_POINTS]; /* friction as measured, which is fed forward: at rest, */
    /* and at whole multiples of this; 0: the first at all velocities */
    double friction_forward_step_mm_s;

    double told_inertia_kg_m2; /* what the loops take the inertia for; 0: what it is */
    /* of the loops, until the motor has the torque; 0 ... below DELAY_MAX */
    uint32_t torque_delay_steps;

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
    /* up to so much above; 0: without an end. If the motor turns the other way: below */
    double home_switch_length_mm;
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
    int32_t sign; /* -1: the motor turns the other way than the axis counts */

    /* Derived from config once, in units of the axis. */
    double friction_per_s;
    double coulomb_mm_s2;
    double encoder_step_mm; /* 0: no quantisation */
    double encoder_steps_per_mm;
    double rated_per_mm_s2; /* part of the rated torque by acceleration */
    double temperature_per_s;

    double position_mm; /* of the motor */
    double velocity_mm_s;
    double torque_mm_s2; /* acceleration by the motor's torque, in the last step */
    double asked_mm_s2
        [DRIVE_PLANT_DELAY_MAX]; /* what the loops have asked for, in step n at n modulo */
    uint32_t asked;
    double encoder_shift_mm; /* the encoder reads this much more than the motor's position */
    double encoder_rounder;  /* rounds to steps and adds the shift */
    double play_mm;          /* the table is behind the motor by this, half the backlash at most */
    double temperature_c;
    struct drive_plant_damage damage;

    struct motor_sense sense; /* as it was said last */
    double sensed_mm;         /* the motor's position then */
};

/* A 400 W servo motor on a ball screw of 10 mm lead; see the room's README for the numbers. */
void drive_plant_set_default(struct drive_plant_config *config);

/*
 * NULL: every field of config is within its range, and the velocity loop is slow enough for its
 * period to be stable (2 pi bandwidth period <= 0.5). Else the name of the first field that is
 * wrong.
 */
const char *drive_plant_check(const struct drive_plant_config *config);

/*
 * config has passed drive_plant_check. The plant stands still at start_mm, without torque.
 * turns_round: the motor turns the other way than the axis counts.
 */
void drive_plant_init(struct drive_plant *plant, const struct drive_plant_config *config,
                      bool turns_round);

/* The drive's way to the motor. plant must stay. */
struct motor_port drive_plant_get_port(struct drive_plant *plant);

/* What the drive has to know of the motor, and how its loops are tuned. */
struct servo_loop_config drive_plant_get_loop(const struct drive_plant_config *config);

/*
 * Where the table stands on the axis: the motor's position, the play in it and the error of pitch.
 */
double drive_plant_table_mm(const struct drive_plant *plant);

/* The encoder reads by_mm more from now on, though nothing has moved. */
void drive_plant_shift_encoder(struct drive_plant *plant, double by_mm);

#endif
