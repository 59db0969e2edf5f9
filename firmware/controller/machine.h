/*
 * A machine: everything the controller must know of the iron it moves. Filled by whoever reads a machine file;
 * machine_set_default is the built-in three-axis mill.
 */
#ifndef TAKT_CONTROLLER_MACHINE_H
#define TAKT_CONTROLLER_MACHINE_H

#include "base/point.h"

#include <stdbool.h>
#include <stdint.h>

#define MACHINE_NAME_MAX 63

/* Largest look-ahead, and the default. The window's memory is fixed at build. */
#define MACHINE_LOOK_AHEAD_MAX 256

/* For a rotary axis read rad where the name says mm. */
struct machine_axis {
    bool present;
    bool rotary;                   /* X Y Z never, A B C always */
    double max_velocity_mm_s;      /* > 0 */
    double max_acceleration_mm_s2; /* > 0 */
    double max_jerk_mm_s3;         /* > 0 */
    double travel_min_mm;          /* machine coordinates; min < max */
    double travel_max_mm;
    uint8_t drive_node;            /* CANopen node id 1 ... 127, one per axis */
    double increments_per_mm;      /* drive position units per mm (per rad) */
    double following_error_max_mm; /* alarm beyond this lag; 0: not watched */
};

struct machine {
    char name[MACHINE_NAME_MAX + 1];
    uint32_t cycle_us; /* control cycle, 100 ... 10000 */
    double
        resolution_per_mm; /* position increments of the controller per mm: chord error and reports */
    double path_tolerance_mm;   /* G64 without P; 0: exact path */
    uint32_t sharp_corners;     /* 1: cutter compensation does not round outer corners */
    uint32_t look_ahead_blocks; /* 1 ... MACHINE_LOOK_AHEAD_MAX */
    struct machine_axis axis[AXIS_COUNT];
    double spindle_max_rpm;
    uint32_t can_bitrate; /* bit/s */
};

/*
 * X Y Z, each 100 mm/s, 1000 mm/s2, 50,000 mm/s3, travel -500 ... 500 mm, drive nodes 1 2 3 with 100,000
 * increments/mm and 1 mm following error; cycle 1 ms, 1000 increments/mm, exact path, 256 blocks of look-ahead,
 * spindle 24,000 rpm, CAN at 1 Mbit/s.
 */
void machine_set_default(struct machine *machine);

/* Bit i set: the machine has axis i. */
unsigned machine_axes(const struct machine *machine);

#endif
