#include "takt/machine_keys.h"

#include "bus/bus.h"

#define IN_SETUP(field) offsetof(struct machine_setup, field)
#define IN_AXIS(field)  offsetof(struct machine_axis, field)
#define IN_DRIVE(field) offsetof(struct drive_plant_config, field)

/* Rows of the table by what they hold. Ranges: from (above: without) the first number to the second. */
#define TEXT(section, name, offset, size, meaning)                                                 \
    {                                                                                              \
        section, name, KEY_TEXT, SCALE_NONE, offset, size, 0, 0, false, meaning                    \
    }
#define COUNT(section, name, type, offset, from, to, meaning)                                      \
    {                                                                                              \
        section, name, type, SCALE_NONE, offset, 0, from, to, false, meaning                       \
    }
#define FROM(section, name, scale, offset, from, to, meaning)                                      \
    {                                                                                              \
        section, name, KEY_DOUBLE, scale, offset, 0, from, to, false, meaning                      \
    }
#define ABOVE(section, name, scale, offset, from, to, meaning)                                     \
    {                                                                                              \
        section, name, KEY_DOUBLE, scale, offset, 0, from, to, true, meaning                       \
    }

const char *const machine_section_names[SECTION_COUNT] = {"machine", "axis", "spindle", "bus",
                                                          "drive"};

/* clang-format off */
const struct machine_key machine_keys[] = {
    TEXT(SECTION_MACHINE, "name", IN_SETUP(machine.name), MACHINE_NAME_MAX + 1,
         "shown in summaries"),
    COUNT(SECTION_MACHINE, "cycle_us", KEY_UINT32, IN_SETUP(machine.cycle_us), 100, 10000,
          "control cycle"),
    ABOVE(SECTION_MACHINE, "resolution_per_mm", SCALE_NONE, IN_SETUP(machine.resolution_per_mm), 0, 1e9,
          "position increments of the controller per mm: one of them is the largest chord error on arcs"),
    FROM(SECTION_MACHINE, "path_tolerance_mm", SCALE_NONE, IN_SETUP(machine.path_tolerance_mm), 0, 100,
         "of G64 without P; 0: exact path"),
    COUNT(SECTION_MACHINE, "look_ahead_blocks", KEY_UINT32, IN_SETUP(machine.look_ahead_blocks), 1,
          MACHINE_LOOK_AHEAD_MAX, "blocks planned ahead"),
    COUNT(SECTION_MACHINE, "sharp_corners", KEY_UINT32, IN_SETUP(machine.sharp_corners), 0, 1,
          "outer corners of compensated contours (G41, G42): 1 sharp, 0 rounded"),
    TEXT(SECTION_MACHINE, "tool_table", IN_SETUP(tool_table), MACHINE_SETUP_PATH_MAX + 1,
         "LinuxCNC .tbl file; relative to this file's folder; empty: no tools"),
    TEXT(SECTION_MACHINE, "parameter_file", IN_SETUP(parameter_file), MACHINE_SETUP_PATH_MAX + 1,
         "LinuxCNC .var file; relative to this file's folder; empty: all parameters 0"),

    COUNT(SECTION_AXIS, "type", KEY_AXIS_TYPE, 0, 0, 0,
          "linear for X Y Z, rotary for A B C"),
    ABOVE(SECTION_AXIS, "max_velocity_mm_s", SCALE_LENGTH, IN_AXIS(max_velocity_mm_s), 0, 1e5,
          "limit of velocity"),
    ABOVE(SECTION_AXIS, "max_acceleration_mm_s2", SCALE_LENGTH, IN_AXIS(max_acceleration_mm_s2), 0, 1e7,
          "limit of acceleration"),
    ABOVE(SECTION_AXIS, "max_jerk_mm_s3", SCALE_LENGTH, IN_AXIS(max_jerk_mm_s3), 0, 1e10,
          "limit of jerk"),
    FROM(SECTION_AXIS, "travel_min_mm", SCALE_LENGTH, IN_AXIS(travel_min_mm), -1e6, 0,
         "lower end of the travel, machine coordinates"),
    FROM(SECTION_AXIS, "travel_max_mm", SCALE_LENGTH, IN_AXIS(travel_max_mm), 0, 1e6,
         "upper end of the travel"),
    COUNT(SECTION_AXIS, "drive_node", KEY_UINT8, IN_AXIS(drive_node), 1, 127,
          "CANopen node id of its drive"),
    ABOVE(SECTION_AXIS, "increments_per_mm", SCALE_PER_LENGTH, IN_AXIS(increments_per_mm), 0, 1e9,
          "position unit of its drive"),
    FROM(SECTION_AXIS, "following_error_max_mm", SCALE_LENGTH, IN_AXIS(following_error_max_mm), 0, 1e6,
         "alarm of the controller beyond this lag; 0: not watched"),

    FROM(SECTION_SPINDLE, "max_rpm", SCALE_NONE, IN_SETUP(machine.spindle_max_rpm), 0, 1e6,
         "highest speed; 0: not limited"),

    COUNT(SECTION_BUS, "bitrate", KEY_UINT32, IN_SETUP(machine.can_bitrate), BUS_BITRATE_MIN, BUS_BITRATE_MAX,
          "CAN, bit/s"),

    ABOVE(SECTION_DRIVE, "travel_per_revolution_mm", SCALE_LENGTH, IN_DRIVE(travel_per_revolution_mm), 0, 1e4,
          "of the axis, per turn of the motor: the lead of its screw"),
    ABOVE(SECTION_DRIVE, "inertia_kg_m2", SCALE_NONE, IN_DRIVE(inertia_kg_m2), 0, 1e3,
          "at the motor's shaft: rotor, screw and moved mass"),
    FROM(SECTION_DRIVE, "viscous_friction_nm_s_per_rad", SCALE_NONE, IN_DRIVE(viscous_friction_nm_s_per_rad), 0, 1e3,
         "torque per angular velocity of the motor"),
    ABOVE(SECTION_DRIVE, "torque_max_nm", SCALE_NONE, IN_DRIVE(torque_max_nm), 0, 1e6,
          "in either direction"),
    COUNT(SECTION_DRIVE, "encoder_counts_per_revolution", KEY_UINT32, IN_DRIVE(encoder_counts_per_revolution), 0, 4294967295,
          "of the motor; 0: exact"),
    ABOVE(SECTION_DRIVE, "position_gain_per_s", SCALE_NONE, IN_DRIVE(position_gain_per_s), 0, 1e4,
          "velocity per position error"),
    FROM(SECTION_DRIVE, "velocity_feed_forward_ratio", SCALE_NONE, IN_DRIVE(velocity_feed_forward_ratio), 0, 1,
         "part of the target's velocity that is fed forward"),
    ABOVE(SECTION_DRIVE, "velocity_bandwidth_hz", SCALE_NONE, IN_DRIVE(velocity_bandwidth_hz), 0, 1e4,
          "of the velocity loop's proportional part"),
    FROM(SECTION_DRIVE, "velocity_integral_time_s", SCALE_NONE, IN_DRIVE(velocity_integral_time_s), 0, 1e3,
         "of the velocity loop; 0: no integral part"),
    COUNT(SECTION_DRIVE, "loop_period_us", KEY_UINT32, IN_DRIVE(loop_period_us), 1, DRIVE_PLANT_LOOP_PERIOD_MAX_US,
          "of both loops and the integration"),
    FROM(SECTION_DRIVE, "following_error_window_mm", SCALE_LENGTH, IN_DRIVE(following_error_window_mm), 0, 1e6,
         "the drive faults beyond (object 6065); 0: not watched"),
    ABOVE(SECTION_DRIVE, "quick_stop_deceleration_mm_s2", SCALE_LENGTH, IN_DRIVE(quick_stop_deceleration_mm_s2), 0, 1e7,
          "object 6085"),
};
/* clang-format on */

const size_t machine_keys_count = sizeof machine_keys / sizeof machine_keys[0];
_Static_assert(sizeof machine_keys / sizeof machine_keys[0] <= MACHINE_KEYS_MAX,
               "room for marks of all keys");
