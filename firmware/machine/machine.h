/*
 * A machine: everything the controller must know of the iron it moves. Filled by whoever reads a
 * machine file; takt_machine_set_default is the built-in three-axis mill.
 */
#ifndef TAKT_MACHINE_H
#define TAKT_MACHINE_H

#include "base/point.h"
#include "correction/need.h"
#include "correction/settings.h"
#include "drive/io_wiring.h"
#include "drive/rates.h"
#include "plan/limits.h"

#include <stdbool.h>
#include <stdint.h>

#define MACHINE_NAME_MAX 63

/* Largest look-ahead, and the default. The window's memory is fixed at build. */
#define MACHINE_LOOK_AHEAD_MAX 256

/* How setpoints reach a drive. */
enum machine_drive_type { MACHINE_DRIVE_CAN, MACHINE_DRIVE_STEP };

/* For a rotary axis read rad where the name says mm. */
struct machine_axis {
    bool present;
    bool rotary;             /* X Y Z never, A B C always */
    uint8_t drive_node;      /* CANopen node id 1 ... 127, each once on a bus */
    uint8_t drive_is_set_up; /* 1: by its maker's tool; it is only looked at, and told nothing */
    uint8_t home_order;      /* 1 first; axes of an order together; 0: not homed at start */
    int8_t home_method;      /* CiA 402, object 6098: 1 ... 37; below 0 its maker's; not 0 */
    uint8_t home_offset_is_position; /* 1: its drive takes 607C for the position at its home */
    uint8_t drive_bus;               /* that its drive is on, 0 ... CAN_BUSES_MAX - 1 */
    uint8_t limiter_band_percent;    /* delta of LIMITER_SMOOTH, of max_velocity_mm_s; 0 ... 99 */
    uint32_t drive_type;             /* enum machine_drive_type */

    /* Object 1018 of its drive, checked at start. 0: whatever it is. */
    uint32_t drive_vendor;
    uint32_t drive_product;
    uint32_t drive_revision;
    uint32_t drive_serial;

    double max_velocity_mm_s;      /* > 0 */
    double max_acceleration_mm_s2; /* > 0 */
    double max_jerk_mm_s3;         /* > 0 */
    double travel_min_mm;          /* machine coordinates; min < max */
    double travel_max_mm;
    /* drive position units per mm (per rad); < 0: the motor turns the other way */
    double increments_per_mm;
    /* of its motor: increments_per_mm is checked by what the drive tells; 0: it is not */
    double travel_per_turn_mm;
    /* of its drive, and of accelerations per mm/s2; 0: increments_per_mm */
    double velocity_units_per_mm_s;
    double following_error_max_mm; /* alarm beyond this lag; 0: not watched */

    double steps_per_mm;     /* step drive: > 0 */
    double step_rate_max_hz; /* step drive: > 0 */

    double home_velocity_mm_s;      /* towards the switch; > 0 */
    double home_zero_velocity_mm_s; /* towards the zero mark; > 0 */
    double home_acceleration_mm_s2; /* > 0 */
    double home_offset_mm;          /* machine coordinate of its home */
    double home_timeout_s;          /* > 0 */
};

/* An axis with two drives. */
struct machine_gantry {
    uint32_t axis;         /* AXIS_COUNT: there is none */
    uint8_t drive_node;    /* of the second drive; everything else is as of the first, but for: */
    uint8_t is_reversed;   /* 1: its motor turns the other way than that of the first */
    int8_t home_method;    /* of the second drive; 0: that of the first, for the same side */
    uint8_t drive_bus;     /* of the second drive */
    double home_offset_mm; /* machine coordinate of its own home */
    double skew_max_mm;    /* alarm when the two are farther apart; > 0 */
};

/* Every axis that can have one. */
#define MACHINE_GANTRIES_MAX AXIS_LINEAR_COUNT

struct machine {
    char name[MACHINE_NAME_MAX + 1];
    uint32_t cycle_us;               /* control cycle, 100 ... 10000 */
    uint32_t spindle_encoder_counts; /* in a revolution; 0: its angle is not measured */
    /* position increments of the controller per mm: chord error and reports */
    double resolution_per_mm;
    double path_tolerance_mm; /* G64 without P; 0: exact path */
    uint32_t sharp_corners;   /* 1: cutter compensation does not round outer corners */
    /* 1: the feed override scales the whole diagram, not the programmed feed alone */
    uint32_t override_proportional;
    uint32_t profile;           /* enum law, of ramps */
    uint32_t landing;           /* enum landing */
    uint32_t limiter;           /* enum limiter_form, classic/limiter.h */
    uint32_t look_ahead_blocks; /* 1 ... MACHINE_LOOK_AHEAD_MAX */
    uint32_t interpolator;      /* enum interpolator_kind, classic/interpolator.h */
    uint32_t step_form;         /* enum steps_form, step/steps.h */
    struct machine_axis axis[AXIS_COUNT];
    double spindle_max_rpm;
    double spindle_ramp_rpm_s;  /* by which its drive changes the speed; > 0 */
    double thread_tolerance_mm; /* a thread farther off the spindle's angle is an alarm; > 0 */
    double spindle_load_limit_percent; /* beyond it the feed is lowered; 0: never */
    double spindle_at_speed_s; /* longest wait for a commanded speed; 0: motion does not wait */
    double tool_change_s;      /* longest change of the tool by a changer at I/O nodes; > 0 */
    uint32_t can_bitrate;      /* of every bus, bit/s */
    /* of CAN FD, bit/s, can_bitrate ... MACHINE_DATA_BITRATE_MAX; 0: classical CAN */
    uint32_t can_data_bitrate;
    uint32_t
        heartbeat_ms; /* period of all heartbeats on the bus, up to 20,000; 0: there are none */
    uint32_t boot_timeout_ms; /* a drive boots within, after a reset */
    uint32_t sdo_timeout_ms;  /* a drive answers a request within */
    double
        position_gain_per_s; /* of drives that follow by velocity; 0: by the limits of the axes */
    uint8_t controller_node; /* the controller's own node id on every bus, 1 ... 127, of no drive */
    uint8_t
        interpolator_word_bits; /* classic/interpolator.h; INTERPOLATOR_WORD_BITS_MIN ... _MAX */
    uint8_t
        error_pdo; /* 1: drives send their error codes in a TPDO, too; 0: by emergencies alone */
    uint8_t interpolator_end_shift;  /* 0 ... INTERPOLATOR_END_SHIFT_MAX */
    uint8_t interpolator_angle_bits; /* 0 (any angle) ... INTERPOLATOR_ANGLE_BITS_MAX */
    struct machine_gantry gantry[MACHINE_GANTRIES_MAX]; /* from the first on */
    struct io_wiring io[IO_NODES_MAX]; /* I/O nodes on the buses, from the first on */
    struct correction_settings correction;
};

/*
 * X Y Z, each 100 mm/s, 1000 mm/s2, 50,000 mm/s3, travel -500 ... 500 mm, drive nodes 1 2 3 with
 * 100,000 increments/mm and 1 mm following error; cycle 1 ms, 1000 increments/mm, exact path, 256
 * blocks of look-ahead, spindle 24,000 rpm with an encoder, CAN at 1 Mbit/s.
 */
void takt_machine_set_default(struct machine *machine);

#define MACHINE_DATA_BITRATE_MAX 8000000
struct drives_rates takt_machine_get_rates(const struct machine *machine);

/* The control cycle. */
static inline double machine_cycle_s(const struct machine *machine)
{
    return 1e-6 * (double)machine->cycle_us;
}

/* Bit i set: the machine has axis i. */
unsigned takt_machine_axes(const struct machine *machine);

/* Gantries from the first on. */
unsigned takt_machine_gantry_count(const struct machine *machine);

/*
 * Nodes of all drives on CAN, in their order: those of the axes, then the second ones of gantries.
 * Their number.
 */
#define MACHINE_DRIVES_MAX AXIS_COUNT
#define MACHINE_NODES_MAX  (AXIS_COUNT + MACHINE_GANTRIES_MAX) /* before it is checked */
unsigned takt_machine_drive_nodes(const struct machine *machine, uint8_t node[MACHINE_NODES_MAX]);
/* The same of one bus. */
unsigned takt_machine_bus_nodes(const struct machine *machine, unsigned bus,
                                uint8_t node[MACHINE_NODES_MAX]);
/* Buses up to the last one with a node; at least 1. */
unsigned takt_machine_bus_count(const struct machine *machine);

/* The most the machine's axes do before correction. */
void takt_machine_motion_bound(const struct machine *machine, struct motion_bound *most);

/* I/O nodes on all buses. */
unsigned takt_machine_io_count(const struct machine *machine);

/* Does the machine have this axis, with a drive of the one kind or of the other? */
static inline bool machine_axis_is_on_can(const struct machine_axis *axis)
{
    return axis->present && axis->drive_type == MACHINE_DRIVE_CAN;
}

static inline bool machine_axis_is_stepped(const struct machine_axis *axis)
{
    return axis->present && axis->drive_type == MACHINE_DRIVE_STEP;
}

#endif
