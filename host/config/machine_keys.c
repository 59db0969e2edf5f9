#include "config/machine_keys.h"

#include "bus/bus.h"
#include "classic/interpolator.h"
#include "classic/limiter.h"
#include "correction/layers.h"

#define IN_SETUP(field)   offsetof(struct machine_setup, field)
#define IN_AXIS(field)    offsetof(struct machine_axis, field)
#define IN_DRIVE(field)   offsetof(struct machine_drive, plant.field)
#define IN_IO(field)      offsetof(struct io_wiring, field)
#define IN_GANTRY(field)  offsetof(struct machine_gantry, field)
#define IN_STEPPER(field) offsetof(struct virtual_stepper_config, field)

/*
 * Rows of the table by what they hold. Ranges: from (above: without) the first number to the
 * second.
 */
#define TEXT(section, name, offset, size, meaning)                                                 \
    {                                                                                              \
        section, name, KEY_TEXT, SCALE_NONE, offset, size, 0, 0, false, meaning, NULL              \
    }
#define PATH(section, name, offset, meaning)                                                       \
    {                                                                                              \
        section, name, KEY_PATH, SCALE_NONE, offset, MACHINE_SETUP_PATH_MAX + 1, 0, 0, false,      \
            meaning, NULL                                                                          \
    }
#define COUNT(section, name, type, offset, from, to, meaning)                                      \
    {                                                                                              \
        section, name, type, SCALE_NONE, offset, 0, from, to, false, meaning, NULL                 \
    }
#define FROM(section, name, scale, offset, from, to, meaning)                                      \
    {                                                                                              \
        section, name, KEY_DOUBLE, scale, offset, 0, from, to, false, meaning, NULL                \
    }
#define ABOVE(section, name, scale, offset, from, to, meaning)                                     \
    {                                                                                              \
        section, name, KEY_DOUBLE, scale, offset, 0, from, to, true, meaning, NULL                 \
    }

#define VECTOR(section, name, scale, offset, count, from, to, meaning)                             \
    {                                                                                              \
        section, name, KEY_VECTOR, scale, offset, count, from, to, false, meaning, NULL            \
    }
#define CHOICE(section, name, type, offset, meaning)                                               \
    {                                                                                              \
        section, name, type, SCALE_NONE, offset, 0, 0, 0, false, meaning, NULL                     \
    }
#define WORD(section, name, words, offset, meaning)                                                \
    {                                                                                              \
        section, name, KEY_WORD, SCALE_NONE, offset, 0, 0, 0, false, meaning, words                \
    }
#define OF_CORRECTION(name, scale, field, count, meaning)                                          \
    VECTOR(SECTION_CORRECTION, name, scale, IN_SETUP(machine.correction.field), count, -1e6, 1e6,  \
           meaning)
#define OF_KNOWN(name, scale, field, meaning)                                                      \
    VECTOR(SECTION_CORRECTION, name, scale, IN_SETUP(known_geometry.field), AXIS_LINEAR_COUNT,     \
           -1e6, 1e6, meaning)
#define OF_GEOMETRY(name, field, count, meaning)                                                   \
    VECTOR(SECTION_GEOMETRY, name, SCALE_NONE, IN_SETUP(geometry.field), count, -1e9, 1e9, meaning)
#define OF_VIBRATION(name, axis, meaning)                                                          \
    VECTOR(SECTION_GEOMETRY, name, SCALE_NONE, IN_SETUP(vibration.mode[axis]),                     \
           (size_t)VIBRATION_MODES *VIBRATION_NUMBERS, -1e9, 1e9, meaning)
/* Where the frequencies of an axis' modes change, and which other axes they swing. */
#define OF_SWING(letter, number)                                                                   \
    CHOICE(SECTION_GEOMETRY, "mode_" letter "_along", KEY_LINEAR_AXIS,                             \
           IN_SETUP(vibration.table[number].along),                                                \
           "axis along which the frequencies of mode_" letter " change; none"),                    \
        VECTOR(SECTION_GEOMETRY, "mode_" letter "_places_mm", SCALE_NONE,                          \
               IN_SETUP(vibration.table[number].places_mm), 2, -1e6, 1e6,                          \
               "first and last of five even places on that axis; 0 0: they do not change"),        \
        VECTOR(SECTION_GEOMETRY, "mode_" letter "_ratio", SCALE_NONE,                              \
               IN_SETUP(vibration.table[number].ratio[0]), VIBRATION_PLACES, 0, 10,                \
               "frequency of the first mode at each of them, over what mode_" letter " says"),     \
        VECTOR(SECTION_GEOMETRY, "mode_" letter "_ratio_2", SCALE_NONE,                            \
               IN_SETUP(vibration.table[number].ratio[1]), VIBRATION_PLACES, 0, 10,                \
               "of the second mode"),                                                              \
        VECTOR(SECTION_GEOMETRY, "mode_" letter "_across", SCALE_NONE,                             \
               IN_SETUP(vibration.across[number]), AXIS_LINEAR_COUNT, -10, 10,                     \
               "parts of this swing that the tool goes along X, Y, Z, too; its own is 0")
/* The six errors of an axis: E_XX and so on. */
#define ERRORS(letter, number)                                                                     \
    OF_GEOMETRY("ex" letter, axis[number][0], DEVIATION_CURVE_NUMBERS,                             \
                "error along X of axis " letter                                                    \
                ": um/m, bow um, sine um, its wavelength mm, its phase deg"),                      \
        OF_GEOMETRY("ey" letter, axis[number][1], DEVIATION_CURVE_NUMBERS, "along Y"),             \
        OF_GEOMETRY("ez" letter, axis[number][2], DEVIATION_CURVE_NUMBERS, "along Z"),             \
        OF_GEOMETRY("ea" letter, axis[number][3], DEVIATION_CURVE_NUMBERS,                         \
                    "rotation about X of axis " letter                                             \
                    ": urad/m, bow urad, sine urad, wavelength mm, phase deg"),                    \
        OF_GEOMETRY("eb" letter, axis[number][4], DEVIATION_CURVE_NUMBERS, "about Y"),             \
        OF_GEOMETRY("ec" letter, axis[number][5], DEVIATION_CURVE_NUMBERS, "about Z")

const char *const machine_section_names[SECTION_COUNT] = {
    "machine",  "axis",  "spindle", "bus", "panel", "correction",
    "geometry", "drive", "stepper", "io",  "gantry"};

/* Words, in the order of the enumeration they stand for. */
static const char *const drive_types[] = {"can", "step", NULL};
static const char *const step_forms[] = {"even", "improved", "plain", NULL};
static const char *const shapers[] = {"none", "neutral", "zv", "mzv", "ei", NULL};
static const char *const interpolators[] = {"exact", "integrate", "rotate", NULL};
static const char *const profiles[] = {"jerk", "smooth", "gentle", NULL};
static const char *const landings[] = {"span", "block", "scale", NULL};
static const char *const limiters[] = {"ceiling", "threshold", "smooth", NULL};
static const char *const override_methods[] = {"adaptive", "proportional", NULL};

/* clang-format off */
const struct machine_key machine_keys[] = {
    TEXT(SECTION_MACHINE, "name", IN_SETUP(machine.name), MACHINE_NAME_MAX + 1,
         "shown in summaries"),
    COUNT(SECTION_MACHINE, "cycle_us", KEY_UINT32, IN_SETUP(machine.cycle_us), 100, 10000,
          "control cycle"),
    ABOVE(SECTION_MACHINE, "resolution_per_mm", SCALE_NONE, IN_SETUP(machine.resolution_per_mm), 0, 1e9,
          "position increments of the controller per mm: one of them is the largest chord error on arcs"),
    FROM(SECTION_MACHINE, "path_tolerance_mm", SCALE_NONE, IN_SETUP(machine.path_tolerance_mm), 0, 100,
         "tolerance of G64 without P; 0: exact path"),
    COUNT(SECTION_MACHINE, "look_ahead_blocks", KEY_UINT32, IN_SETUP(machine.look_ahead_blocks), 1,
          MACHINE_LOOK_AHEAD_MAX, "blocks planned ahead"),
    COUNT(SECTION_MACHINE, "sharp_corners", KEY_UINT32, IN_SETUP(machine.sharp_corners), 0, 1,
          "outer corners of compensated contours (G41, G42): 1 sharp, 0 rounded"),
    WORD(SECTION_MACHINE, "law", profiles, IN_SETUP(machine.profile),
         "rounding of ramps: jerk (the fastest), smooth (jerk continuous) or gentle (its derivative too)"),
    WORD(SECTION_MACHINE, "landing", landings, IN_SETUP(machine.landing),
         "span: a cycle falls on stops and slow joints exactly; block: on every block's end; for comparison scale: by a factor on the feed, which steps at junctions"),
    WORD(SECTION_MACHINE, "limiter", limiters, IN_SETUP(machine.limiter),
         "how axis velocities are limited above 100 %: ceiling (planned); for comparison threshold or smooth: a factor on the feed, a cycle late"),
    WORD(SECTION_MACHINE, "override_method", override_methods, IN_SETUP(machine.override_proportional),
         "adaptive: the override scales the programmed feed; proportional: every feed"),
    WORD(SECTION_MACHINE, "interpolator", interpolators, IN_SETUP(machine.interpolator),
         "exact; for comparison integrate (lines by digital integration) or rotate (arcs by rotating the radius vector)"),
    COUNT(SECTION_MACHINE, "interpolator_word_bits", KEY_UINT8, IN_SETUP(machine.interpolator_word_bits),
          INTERPOLATOR_WORD_BITS_MIN, INTERPOLATOR_WORD_BITS_MAX, "integrate: bits of a signed word for positions over the travel"),
    COUNT(SECTION_MACHINE, "interpolator_end_shift", KEY_UINT8, IN_SETUP(machine.interpolator_end_shift), 0,
          INTERPOLATOR_END_SHIFT_MAX, "integrate: k of N = 2^k, the cycles that share what is left at the end of a line"),
    COUNT(SECTION_MACHINE, "interpolator_angle_bits", KEY_UINT8, IN_SETUP(machine.interpolator_angle_bits), 0,
          INTERPOLATOR_ANGLE_BITS_MAX, "rotate: bits of a cycle's angle, of which the largest is that of the axes' full feed; 6 to 8 as the source has it; 0: any angle"),
    WORD(SECTION_MACHINE, "shaper", shapers, IN_SETUP(shaper),
         "setpoints that do not make the modes of geometry.mode_x swing: none; zv; neutral (the tool keeps its way closer, for some more time); for comparison mzv or ei"),
    WORD(SECTION_MACHINE, "step_form", step_forms, IN_SETUP(machine.step_form),
         "pulses of step drives: even (each axis at its own times); by evaluation functions improved or plain (one axis at a time)"),
    ABOVE(SECTION_MACHINE, "tool_change_s", SCALE_NONE, IN_SETUP(machine.tool_change_s), 0, 3600,
          "longest change of the tool (M6) by a changer at I/O nodes"),
    TEXT(SECTION_MACHINE, "chain", IN_SETUP(chain), CHAIN_TEXT_MAX,
         "which units carry the part and which the tool, from the part (w) over the bed (b) to the tool (t), such as w C X b Y Z t; empty: w b X Y Z t, a turning table on the bed"),
    PATH(SECTION_MACHINE, "tool_table", IN_SETUP(tool_table),
         "LinuxCNC .tbl file; relative to this file's folder; empty: no tools"),
    PATH(SECTION_MACHINE, "parameter_file", IN_SETUP(parameter_file),
         "LinuxCNC .var file; relative to this file's folder; empty: all parameters 0"),

    COUNT(SECTION_AXIS, "type", KEY_AXIS_TYPE, 0, 0, 0,
          "linear for X Y Z, rotary for A B C"),
    ABOVE(SECTION_AXIS, "max_velocity_mm_s", SCALE_LENGTH, IN_AXIS(max_velocity_mm_s), 0, 1e5,
          "limit of velocity"),
    ABOVE(SECTION_AXIS, "max_acceleration_mm_s2", SCALE_LENGTH, IN_AXIS(max_acceleration_mm_s2), 0, 1e7,
          "limit of acceleration"),
    ABOVE(SECTION_AXIS, "max_jerk_mm_s3", SCALE_LENGTH, IN_AXIS(max_jerk_mm_s3), 0, 1e10,
          "limit of jerk"),
    COUNT(SECTION_AXIS, "limiter_band_percent", KEY_UINT8, IN_AXIS(limiter_band_percent), 0, LIMITER_BAND_PERCENT_MAX,
          "limiter=smooth bends the feed so far below and above max_velocity, in percent of it; 0: as threshold does"),
    FROM(SECTION_AXIS, "travel_min_mm", SCALE_LENGTH, IN_AXIS(travel_min_mm), -1e6, 0,
         "lower end of the travel, machine coordinates"),
    FROM(SECTION_AXIS, "travel_max_mm", SCALE_LENGTH, IN_AXIS(travel_max_mm), 0, 1e6,
         "upper end of the travel"),
    COUNT(SECTION_AXIS, "drive_node", KEY_UINT8, IN_AXIS(drive_node), 1, 127,
          "CANopen node id of its drive"),
    COUNT(SECTION_AXIS, "drive_bus", KEY_UINT8, IN_AXIS(drive_bus), 0, CAN_BUSES_MAX - 1,
          "CAN bus its drive is on: 0 is can0, 1 is can1; node ids are each bus's own"),
    FROM(SECTION_AXIS, "increments_per_mm", SCALE_PER_LENGTH, IN_AXIS(increments_per_mm), -1e9, 1e9,
         "position unit of its drive; negative: its motor turns the other way"),
    FROM(SECTION_AXIS, "travel_per_turn_mm", SCALE_LENGTH, IN_AXIS(travel_per_turn_mm), 0, 1e6,
         "travel in a turn of the motor: increments_per_mm is checked by what the drive tells of its scaling (608F, 6091, 6092); 0: it is not"),
    COUNT(SECTION_AXIS, "drive_is_set_up", KEY_UINT8, IN_AXIS(drive_is_set_up), 0, 1,
          "1: its maker's tool has set up the drive, PDOs and all: takt looks at it and changes nothing"),
    FROM(SECTION_AXIS, "velocity_units_per_mm_s", SCALE_PER_LENGTH, IN_AXIS(velocity_units_per_mm_s), 0, 1e9,
         "velocity unit of its drive (60FF, 6099), accelerations the same in a second: where it is rpm, 60 / travel of a turn; 0: increments_per_mm"),
    FROM(SECTION_AXIS, "following_error_max_mm", SCALE_LENGTH, IN_AXIS(following_error_max_mm), 0, 1e6,
         "alarm of the controller beyond this lag; 0: not watched"),
    WORD(SECTION_AXIS, "drive_type", drive_types, IN_AXIS(drive_type),
         "can: a CiA 402 drive on the bus; step: pulses of a step/direction output"),
    ABOVE(SECTION_AXIS, "steps_per_mm", SCALE_PER_LENGTH, IN_AXIS(steps_per_mm), 0, 1e9,
          "steps of a step drive"),
    ABOVE(SECTION_AXIS, "step_rate_max_hz", SCALE_NONE, IN_AXIS(step_rate_max_hz), 0, 1e7,
          "highest step rate of a step drive"),
    COUNT(SECTION_AXIS, "drive_vendor", KEY_UINT32, IN_AXIS(drive_vendor), 0, 4294967295,
          "vendor id its drive must have (object 1018:01), such as 0x1F; 0: any"),
    COUNT(SECTION_AXIS, "drive_product", KEY_UINT32, IN_AXIS(drive_product), 0, 4294967295,
          "product code its drive must have (1018:02; virtual drives: 0x402); 0: any"),
    COUNT(SECTION_AXIS, "drive_revision", KEY_UINT32, IN_AXIS(drive_revision), 0, 4294967295,
          "revision its drive must have (1018:03); 0: any"),
    COUNT(SECTION_AXIS, "drive_serial", KEY_UINT32, IN_AXIS(drive_serial), 0, 4294967295,
          "serial number its drive must have (1018:04); 0: any"),
    COUNT(SECTION_AXIS, "home_order", KEY_UINT8, IN_AXIS(home_order), 0, 100,
          "at start axes are homed in this order, those of one number together; 0: not homed"),
    COUNT(SECTION_AXIS, "home_method", KEY_INT8, IN_AXIS(home_method), -128, 37,
          "how its drive finds its home (CiA 402, object 6098); 37: where it stands; below 0: a method of its maker"),
    ABOVE(SECTION_AXIS, "home_velocity_mm_s", SCALE_LENGTH, IN_AXIS(home_velocity_mm_s), 0, 1e5,
          "towards the switch (6099:01)"),
    ABOVE(SECTION_AXIS, "home_zero_velocity_mm_s", SCALE_LENGTH, IN_AXIS(home_zero_velocity_mm_s), 0, 1e5,
          "towards the zero mark (6099:02)"),
    ABOVE(SECTION_AXIS, "home_acceleration_mm_s2", SCALE_LENGTH, IN_AXIS(home_acceleration_mm_s2), 0, 1e7,
          "while homing (609A)"),
    FROM(SECTION_AXIS, "home_offset_mm", SCALE_LENGTH, IN_AXIS(home_offset_mm), -1e6, 1e6,
         "machine coordinate of its home"),
    COUNT(SECTION_AXIS, "home_offset_is_position", KEY_UINT8, IN_AXIS(home_offset_is_position), 0, 1,
          "0: its drive takes object 607C as CiA 402 says, minus the position at its home; 1: as that position"),
    ABOVE(SECTION_AXIS, "home_timeout_s", SCALE_NONE, IN_AXIS(home_timeout_s), 0, 3600,
          "alarm if homing takes longer"),

    FROM(SECTION_SPINDLE, "max_rpm", SCALE_NONE, IN_SETUP(machine.spindle_max_rpm), 0, 1e6,
         "highest speed; 0: not limited"),
    FROM(SECTION_SPINDLE, "load_limit_percent", SCALE_NONE, IN_SETUP(machine.spindle_load_limit_percent), 0, 1000,
         "beyond this load the feed is lowered until it is gone; 0: never"),
    FROM(SECTION_SPINDLE, "at_speed_s", SCALE_NONE, IN_SETUP(machine.spindle_at_speed_s), 0, 3600,
         "motion waits at most this long for a commanded speed, then alarm; 0: it does not wait"),
    FROM(SECTION_SPINDLE, "ramp_rpm_s", SCALE_NONE, IN_SETUP(machine.spindle_ramp_rpm_s), 1e-3, 1e9,
         "how fast its drive changes the speed, rpm per second: tapping turns back by it"),
    FROM(SECTION_SPINDLE, "inertia_kg_m2", SCALE_NONE, IN_SETUP(spindle.inertia_kg_m2), 1e-9, 1e3,
         "rotor, tool and what turns with them"),
    FROM(SECTION_SPINDLE, "friction_nm_s_per_rad", SCALE_NONE, IN_SETUP(spindle.friction_nm_s_per_rad), 0, 1e3,
         "torque per angular velocity"),
    FROM(SECTION_SPINDLE, "rated_torque_nm", SCALE_NONE, IN_SETUP(spindle.rated_torque_nm), 1e-6, 1e6,
         "load is told in percent of it"),
    FROM(SECTION_SPINDLE, "torque_limit_percent", SCALE_NONE, IN_SETUP(spindle.torque_limit_percent), 1, 1000,
         "the most its drive gives"),
    FROM(SECTION_SPINDLE, "overload_percent", SCALE_NONE, IN_SETUP(spindle.overload_percent), 1, 1000,
         "its drive trips above this load"),
    FROM(SECTION_SPINDLE, "overload_s", SCALE_NONE, IN_SETUP(spindle.overload_s), 0, 1e6,
         "for this long"),
    FROM(SECTION_SPINDLE, "at_speed_percent", SCALE_NONE, IN_SETUP(spindle.at_speed_percent), 0.01, 100,
         "closer to the commanded speed than this is at speed"),
    COUNT(SECTION_SPINDLE, "encoder_counts_per_revolution", KEY_UINT32,
          IN_SETUP(machine.spindle_encoder_counts), 0, 16777216,
          "counts of the spindle encoder, which G33, G33.1 and G76 follow; 0: none, and they are refused"),
    ABOVE(SECTION_SPINDLE, "thread_tolerance_mm", SCALE_NONE, IN_SETUP(machine.thread_tolerance_mm), 0, 100,
          "a larger deviation of a thread from the spindle's angle is an alarm; a tap may go this far below its bottom"),
    FROM(SECTION_SPINDLE, "encoder_noise_counts", SCALE_NONE, IN_SETUP(spindle.encoder_noise_counts), 0, 1e6,
         "largest error of the virtual encoder, random but the same in every run"),
    FROM(SECTION_SPINDLE, "ripple_percent", SCALE_NONE, IN_SETUP(spindle.ripple_percent), 0, 1000,
         "torque of the virtual motor swings by this part of the rated torque"),
    FROM(SECTION_SPINDLE, "ripple_per_revolution", SCALE_NONE, IN_SETUP(spindle.ripple_per_revolution), 0, 1000,
         "swings in a revolution"),
    FROM(SECTION_SPINDLE, "cut_width_mm", SCALE_NONE, IN_SETUP(spindle.cut_width_mm), 0, 1e4,
         "width of every cut, for the load; 0: it turns in air"),
    FROM(SECTION_SPINDLE, "cut_depth_mm", SCALE_NONE, IN_SETUP(spindle.cut_depth_mm), 0, 1e4,
         "depth of every cut, for the load; 0: it turns in air"),
    FROM(SECTION_SPINDLE, "cutting_force_n_per_mm2", SCALE_NONE, IN_SETUP(spindle.cutting_force_n_per_mm2), 0, 1e5,
         "specific cutting force of the material: aluminium 700, steel 2000"),

    COUNT(SECTION_BUS, "bitrate", KEY_UINT32, IN_SETUP(machine.can_bitrate), BUS_BITRATE_MIN, BUS_BITRATE_MAX,
          "CAN, bit/s"),
    COUNT(SECTION_BUS, "data_bitrate", KEY_UINT32, IN_SETUP(machine.can_data_bitrate), 0, BUS_DATA_BITRATE_MAX,
          "CAN FD: every frame has its data at this rate, bit/s, and targets of all drives share one; 0: classical CAN"),
    COUNT(SECTION_BUS, "heartbeat_ms", KEY_UINT32, IN_SETUP(machine.heartbeat_ms), 0, 20000,
          "period of the heartbeats of drives and controller; three missed are an alarm; 0: none"),
    COUNT(SECTION_BUS, "boot_timeout_ms", KEY_UINT32, IN_SETUP(machine.boot_timeout_ms), 1, 600000,
          "longest time a drive takes to boot; then it is reset once more, and after as long asked for the last time; above 5 s also over each state on its way to operation"),
    COUNT(SECTION_BUS, "sdo_timeout_ms", KEY_UINT32, IN_SETUP(machine.sdo_timeout_ms), 1, 600000,
          "longest time a drive takes to answer a request while it is started"),
    FROM(SECTION_BUS, "position_gain_per_s", SCALE_NONE, IN_SETUP(machine.position_gain_per_s), 0, 1e4,
         "of drives without a mode of position: velocity that a lag of 1 adds to a setpoint's; 0: by the limits and the cycle"),
    COUNT(SECTION_BUS, "controller_node", KEY_UINT8, IN_SETUP(machine.controller_node), 1, 127,
          "CANopen node id of the controller"),
    COUNT(SECTION_BUS, "error_pdo", KEY_UINT8, IN_SETUP(machine.error_pdo), 0, 1,
          "1: drives send their error codes in a TPDO beside emergencies; 0: they do not, which takes a frame less in a cycle"),
    COUNT(SECTION_BUS, "drives_stay_on", KEY_UINT32, IN_SETUP(drives_stay_on), 0, 1,
          "at the end of a run or a service drives are left: 1 switched on, without torque; 0 off"),

    TEXT(SECTION_PANEL, "listen", IN_SETUP(panel.listen), MACHINE_SETUP_PATH_MAX + 1,
         "HOST:PORT of the panel on Modbus TCP (`takt serve`); empty: not on TCP"),
    TEXT(SECTION_PANEL, "allow", IN_SETUP(panel.allow), MACHINE_SETUP_PATH_MAX + 1,
         "addresses that may connect, as 192.168.1.0/24,::1; empty: all that reach it"),
    COUNT(SECTION_PANEL, "password", KEY_UINT32, IN_SETUP(panel.password), 0, 4294967295,
          "panels must write it to the register PASSWORD before anything else; 0: none"),

    PATH(SECTION_DRIVE, "eds", offsetof(struct machine_drive, eds),
         "electronic data sheet (CiA 306): the drive has its objects, PDOs and modes; relative to this file's folder; empty: takt's own drive"),
    PATH(SECTION_DRIVE, "dcf", offsetof(struct machine_drive, dcf),
         "concise configuration (CiA 302, 1F22) that the drive of this node, also a real one, is checked against, and else set up by; empty: by takt"),
    COUNT(SECTION_DRIVE, "boot_time_ms", KEY_UINT32, offsetof(struct machine_drive, boot_ms), 0, 600000,
          "from a reset to its boot-up message"),
    COUNT(SECTION_DRIVE, "sdo_time_ms", KEY_UINT32, offsetof(struct machine_drive, sdo_ms), 0, 600000,
          "from a request to its answer"),
    ABOVE(SECTION_DRIVE, "travel_per_revolution_mm", SCALE_LENGTH, IN_DRIVE(travel_per_revolution_mm), 0, 1e4,
          "travel of the axis per turn of the motor: the lead of its screw"),
    ABOVE(SECTION_DRIVE, "inertia_kg_m2", SCALE_NONE, IN_DRIVE(inertia_kg_m2), 0, 1e3,
          "at the motor's shaft: rotor, screw and moved mass"),
    FROM(SECTION_DRIVE, "viscous_friction_nm_s_per_rad", SCALE_NONE, IN_DRIVE(viscous_friction_nm_s_per_rad), 0, 1e3,
         "torque per angular velocity of the motor"),
    FROM(SECTION_DRIVE, "coulomb_friction_nm", SCALE_NONE, IN_DRIVE(coulomb_friction_nm), 0, 1e6,
         "torque against any motion of the motor"),
    ABOVE(SECTION_DRIVE, "torque_max_nm", SCALE_NONE, IN_DRIVE(torque_max_nm), 0, 1e6,
          "in either direction"),
    ABOVE(SECTION_DRIVE, "torque_rated_nm", SCALE_NONE, IN_DRIVE(torque_rated_nm), 0, 1e6,
          "for good; object 6077 counts in thousandths of it"),
    COUNT(SECTION_DRIVE, "encoder_counts_per_revolution", KEY_UINT32, IN_DRIVE(encoder_counts_per_revolution), 0, 4294967295,
          "counts of the motor's encoder; 0: exact"),
    ABOVE(SECTION_DRIVE, "position_gain_per_s", SCALE_NONE, IN_DRIVE(position_gain_per_s), 0, 1e4,
          "velocity per position error"),
    FROM(SECTION_DRIVE, "velocity_feed_forward_ratio", SCALE_NONE, IN_DRIVE(velocity_feed_forward_ratio), 0, 1,
         "part of the target's velocity that is fed forward"),
    ABOVE(SECTION_DRIVE, "velocity_bandwidth_hz", SCALE_NONE, IN_DRIVE(velocity_bandwidth_hz), 0, 1e4,
          "bandwidth of the velocity loop's proportional part"),
    FROM(SECTION_DRIVE, "velocity_integral_time_s", SCALE_NONE, IN_DRIVE(velocity_integral_time_s), 0, 1e3,
         "integral time of the velocity loop; 0: no integral part"),
    FROM(SECTION_DRIVE, "torque_feed_forward_ratio", SCALE_NONE, IN_DRIVE(torque_feed_forward_ratio), 0, 1,
         "part of the torque for the target's acceleration that is fed forward"),
    VECTOR(SECTION_DRIVE, "friction_forward_nm", SCALE_NONE, IN_DRIVE(friction_forward_nm), FRICTION_POINTS, 0, 1e6,
           "friction that is fed forward: at rest, and at whole multiples of a velocity (takt friction measures it)"),
    FROM(SECTION_DRIVE, "friction_forward_step_mm_s", SCALE_LENGTH, IN_DRIVE(friction_forward_step_mm_s), 0, 1e6,
         "that velocity; 0: the first number counts at all"),
    FROM(SECTION_DRIVE, "told_inertia_kg_m2", SCALE_NONE, IN_DRIVE(told_inertia_kg_m2), 0, 1e3,
         "what its loops take the inertia for; 0: what it is"),
    COUNT(SECTION_DRIVE, "torque_delay_steps", KEY_UINT32, IN_DRIVE(torque_delay_steps), 0, DRIVE_PLANT_DELAY_MAX - 1,
          "steps of its loops until the motor has the torque they ask for: current loop, filters, computation"),
    COUNT(SECTION_DRIVE, "loop_period_us", KEY_UINT32, IN_DRIVE(loop_period_us), 1, DRIVE_PLANT_LOOP_PERIOD_MAX_US,
          "period of both loops and the integration"),
    FROM(SECTION_DRIVE, "backlash_mm", SCALE_LENGTH, IN_DRIVE(backlash_mm), 0, 1e3,
         "play between motor and table"),
    FROM(SECTION_DRIVE, "pitch_error_mm", SCALE_LENGTH, IN_DRIVE(pitch_error_mm), 0, 1e3,
         "amplitude of the screw's error, a sine over the axis"),
    ABOVE(SECTION_DRIVE, "pitch_error_period_mm", SCALE_LENGTH, IN_DRIVE(pitch_error_period_mm), 0, 1e6,
          "its period"),
    FROM(SECTION_DRIVE, "ambient_temperature_c", SCALE_NONE, IN_DRIVE(ambient_temperature_c), -100, 200,
         "degrees Celsius; also of the motor at power-on"),
    FROM(SECTION_DRIVE, "temperature_rise_k", SCALE_NONE, IN_DRIVE(temperature_rise_k), 0, 1e4,
         "final temperature rise of the motor at its rated torque"),
    ABOVE(SECTION_DRIVE, "temperature_time_s", SCALE_NONE, IN_DRIVE(temperature_time_s), 0, 1e6,
          "time constant of the motor's temperature"),
    FROM(SECTION_DRIVE, "temperature_max_c", SCALE_NONE, IN_DRIVE(temperature_max_c), 0, 1e4,
         "the drive faults beyond (EMCY 4310); 0: not watched"),
    FROM(SECTION_DRIVE, "start_mm", SCALE_LENGTH, IN_DRIVE(start_mm), -1e6, 1e6,
         "where the table stands at power-on"),
    COUNT(SECTION_DRIVE, "absolute_encoder", KEY_UINT32, IN_DRIVE(absolute_encoder), 0, 1,
          "1: the encoder knows its position at power-on; 0: it counts from 0 there, until homed"),
    FROM(SECTION_DRIVE, "limit_switch_min_mm", SCALE_LENGTH, IN_DRIVE(limit_switch_min_mm), -1e6, 1e6,
         "the negative limit switch is active at or below"),
    FROM(SECTION_DRIVE, "limit_switch_max_mm", SCALE_LENGTH, IN_DRIVE(limit_switch_max_mm), -1e6, 1e6,
         "the positive limit switch is active at or above"),
    FROM(SECTION_DRIVE, "home_switch_mm", SCALE_LENGTH, IN_DRIVE(home_switch_mm), -1e6, 1e6,
         "the home switch is active at or above"),
    FROM(SECTION_DRIVE, "home_switch_length_mm", SCALE_LENGTH, IN_DRIVE(home_switch_length_mm), 0, 1e6,
         "up to so much above; 0: without an end"),
    FROM(SECTION_DRIVE, "hard_stop_min_mm", SCALE_LENGTH, IN_DRIVE(hard_stop_min_mm), -2e6, 2e6,
         "the motor comes no farther"),
    FROM(SECTION_DRIVE, "hard_stop_max_mm", SCALE_LENGTH, IN_DRIVE(hard_stop_max_mm), -2e6, 2e6, "likewise"),
    FROM(SECTION_DRIVE, "following_error_window_mm", SCALE_LENGTH, IN_DRIVE(following_error_window_mm), 0, 1e6,
         "the drive faults beyond (object 6065); 0: not watched"),
    COUNT(SECTION_DRIVE, "following_error_timeout_ms", KEY_UINT32, IN_DRIVE(following_error_timeout_ms), 0, 65535,
          "for longer than this (object 6066)"),
    ABOVE(SECTION_DRIVE, "quick_stop_deceleration_mm_s2", SCALE_LENGTH, IN_DRIVE(quick_stop_deceleration_mm_s2), 0, 1e7,
          "object 6085"),

    ABOVE(SECTION_STEPPER, "rate_max_hz", SCALE_NONE, IN_STEPPER(rate_max_hz), 0, 1e9,
          "steps that come faster are missed by the motor"),
    COUNT(SECTION_STEPPER, "encoder", KEY_UINT32, IN_STEPPER(has_encoder), 0, 1,
          "1: the motor has one, so that the controller sees missed steps; 0: it has none"),

    CHOICE(SECTION_GANTRY, "axis", KEY_LINEAR_AXIS, IN_GANTRY(axis),
           "axis X, Y or Z that has two drives; none. [gantry 2] and [gantry 3] are further ones"),
    COUNT(SECTION_GANTRY, "drive_node", KEY_UINT8, IN_GANTRY(drive_node), 1, 127,
          "CANopen node id of its second drive; its other keys are those of the axis"),
    COUNT(SECTION_GANTRY, "drive_bus", KEY_UINT8, IN_GANTRY(drive_bus), 0, CAN_BUSES_MAX - 1,
          "CAN bus the second drive is on"),
    COUNT(SECTION_GANTRY, "is_reversed", KEY_UINT8, IN_GANTRY(is_reversed), 0, 1,
          "1: the second motor turns the other way than the first; it looks for its home on the same side"),
    COUNT(SECTION_GANTRY, "home_method", KEY_INT8, IN_GANTRY(home_method), -128, 37,
          "how the second drive finds its home; 0: as that of the axis, on the same side"),
    FROM(SECTION_GANTRY, "home_offset_mm", SCALE_NONE, IN_GANTRY(home_offset_mm), -1e6, 1e6,
         "machine coordinate of the home of the second drive: its difference to that of the axis squares the gantry"),
    FROM(SECTION_GANTRY, "skew_max_mm", SCALE_NONE, IN_GANTRY(skew_max_mm), 0, 1e3,
         "alarm when the two drives are farther apart"),

    COUNT(SECTION_IO, "node", KEY_UINT8, IN_IO(node), 1, 127,
          "CANopen node id of an I/O node (CiA 401) on the drives' bus; [io 1] is the first"),
    COUNT(SECTION_IO, "bus", KEY_UINT8, IN_IO(bus), 0, CAN_BUSES_MAX - 1, "CAN bus it is on"),
    CHOICE(SECTION_IO, "outputs", KEY_OUTPUTS, IN_IO(output),
           "its outputs from bit 0 on: P0 ... P31 (M62 to M65), flood, mist, spindle, ccw (it turns counter-clockwise), tool_change (M6), T0 ... T7 (bits of the tool number), - (free); with ! inverted"),
    CHOICE(SECTION_IO, "analogue_outputs", KEY_ANALOGUES, IN_IO(analogue),
           "its analogue outputs from the first on: E0 ... E3 (M67 and M68, per cent of the range), - (free)"),
    CHOICE(SECTION_IO, "inputs", KEY_INPUTS, IN_IO(input),
           "its inputs from bit 0 on: P0 ... P31 (M66), stop and limit (closed circuits that stop the axes when they open), tool_changed (M6 waits for it), - (free); with ! inverted"),

    PATH(SECTION_CORRECTION, "volume_table", IN_SETUP(volume_table),
         "CSV table over X Y Z and the turning axis; relative to this file's folder; empty: none"),
    PATH(SECTION_CORRECTION, "axis_table_x", IN_SETUP(axis_table[AXIS_X]),
         "CSV table over one axis: pitch, straightness, backlash; empty: none"),
    PATH(SECTION_CORRECTION, "axis_table_y", IN_SETUP(axis_table[AXIS_Y]), "likewise"),
    PATH(SECTION_CORRECTION, "axis_table_z", IN_SETUP(axis_table[AXIS_Z]), "likewise"),
    PATH(SECTION_CORRECTION, "axis_table_a", IN_SETUP(axis_table[AXIS_A]), "likewise"),
    PATH(SECTION_CORRECTION, "axis_table_b", IN_SETUP(axis_table[AXIS_B]), "likewise"),
    PATH(SECTION_CORRECTION, "axis_table_c", IN_SETUP(axis_table[AXIS_C]), "likewise"),
    PATH(SECTION_CORRECTION, "unit_table_x", IN_SETUP(unit_table[AXIS_X]),
         "CSV table of the errors of a unit over its axis, three shifts and three turns, which act along machine.chain; empty: none"),
    PATH(SECTION_CORRECTION, "unit_table_y", IN_SETUP(unit_table[AXIS_Y]), "likewise"),
    PATH(SECTION_CORRECTION, "unit_table_z", IN_SETUP(unit_table[AXIS_Z]), "likewise"),
    PATH(SECTION_CORRECTION, "unit_table_a", IN_SETUP(unit_table[AXIS_A]), "likewise"),
    PATH(SECTION_CORRECTION, "unit_table_b", IN_SETUP(unit_table[AXIS_B]), "likewise"),
    PATH(SECTION_CORRECTION, "unit_table_c", IN_SETUP(unit_table[AXIS_C]), "likewise"),
    OF_KNOWN("squareness_urad", SCALE_PPM, squareness_rad, "of Y to X about Z, of Z to X about Y, of Z to Y about X, where unit tables do not contain it"),
    OF_KNOWN("tool_mm", SCALE_NONE, tool_mm, "from spindle nose to tool point: the arm of the turns of units"),
    OF_KNOWN("turn_centre_mm", SCALE_NONE, centre_mm, "a point of the turning axis, about which the turns of its unit act"),
    CHOICE(SECTION_CORRECTION, "off", KEY_LAYERS, IN_SETUP(machine.correction.off),
           "layers that are off until switched on:" CORRECTION_LAYER_WORDS),
    CHOICE(SECTION_CORRECTION, "turn_axis", KEY_AXIS, IN_SETUP(machine.correction.turn_axis),
           "rotary axis that turns the part, the fourth coordinate of matrix and set-up; none"),
    OF_CORRECTION("matrix_x", SCALE_NONE, machine[0], 4, "added to X per mm of X, Y, Z and rad of the turning axis"),
    OF_CORRECTION("matrix_y", SCALE_NONE, machine[1], 4, "to Y"),
    OF_CORRECTION("matrix_z", SCALE_NONE, machine[2], 4, "to Z"),
    OF_CORRECTION("matrix_turn", SCALE_NONE, machine[3], 4, "to the turning axis, rad"),
    OF_CORRECTION("workpiece_x", SCALE_NONE, workpiece[0], 4, "added to X per mm from the part's zero"),
    OF_CORRECTION("workpiece_y", SCALE_NONE, workpiece[1], 4, "to Y"),
    OF_CORRECTION("workpiece_z", SCALE_NONE, workpiece[2], 4, "to Z"),
    OF_CORRECTION("workpiece_turn", SCALE_NONE, workpiece[3], 4, "to the turning axis, rad"),
    OF_CORRECTION("overhang_x", SCALE_NONE, overhang[0], 3, "added to X per mm of tool offset X, Y, Z"),
    OF_CORRECTION("overhang_y", SCALE_NONE, overhang[1], 3, "to Y"),
    OF_CORRECTION("overhang_z", SCALE_NONE, overhang[2], 3, "to Z"),
    OF_CORRECTION("overhang_turn", SCALE_NONE, overhang[3], 3, "to the turning axis, rad"),
    OF_CORRECTION("setup_offset_mm", SCALE_NONE, setup_offset_mm, 3, "the part stands displaced by X, Y, Z"),
    OF_CORRECTION("setup_rotation_deg", SCALE_DEGREE, setup_rotation_rad, 3, "and turned about X, Y, Z, in this order"),
    OF_CORRECTION("setup_pivot_mm", SCALE_NONE, setup_pivot_mm, 3, "about this point; with turn_axis a point of its axis, since the set-up turns with the table"),
    FROM(SECTION_CORRECTION, "setup_turn_deg", SCALE_DEGREE, IN_SETUP(machine.correction.setup_turn_rad), -360, 360,
         "turn of the turning axis"),
    OF_CORRECTION("thermal_um_per_m_k", SCALE_PPM, thermal_per_k, 3, "growth of X, Y, Z per K"),
    OF_CORRECTION("thermal_reference_mm", SCALE_NONE, thermal_reference_mm, 3, "where growth moves nothing"),
    FROM(SECTION_CORRECTION, "wear_along_um_per_m", SCALE_PPM, IN_SETUP(machine.correction.wear_along_per_mm), 0, 1e4,
         "what a tool loses of its length per metre of cut"),
    FROM(SECTION_CORRECTION, "wear_along_um_per_min", SCALE_UM_MIN, IN_SETUP(machine.correction.wear_along_mm_s), 0, 1e4,
         "and per minute of cutting"),
    FROM(SECTION_CORRECTION, "wear_across_um_per_m", SCALE_PPM, IN_SETUP(machine.correction.wear_across_per_mm), 0, 1e4,
         "what it loses of its radius, corrected where G41 or G42 says which side it cuts on"),
    FROM(SECTION_CORRECTION, "wear_across_um_per_min", SCALE_UM_MIN, IN_SETUP(machine.correction.wear_across_mm_s), 0, 1e4,
         "and per minute"),
    OF_CORRECTION("tool_direction", SCALE_NONE, tool_direction, 3,
                  "X, Y, Z of a line from the tool's point into its spindle, of any length, with head_axis at 0: wear is corrected along it and across"),
    CHOICE(SECTION_CORRECTION, "head_axis", KEY_AXIS, IN_SETUP(machine.correction.head_axis),
           "rotary axis whose head turns the tool, right-handed; none"),
    ABOVE(SECTION_CORRECTION, "largest_mm", SCALE_NONE, IN_SETUP(machine.correction.largest_mm), 0, 100,
          "a table with a larger correction (mm or rad) is refused"),
    ABOVE(SECTION_CORRECTION, "steepest_ratio", SCALE_NONE, IN_SETUP(machine.correction.steepest_ratio), 0, 0.1,
          "and one whose correction changes by more than this per mm or rad"),
    ABOVE(SECTION_CORRECTION, "fade_s", SCALE_NONE, IN_SETUP(machine.correction.fade_s), 0, 3600,
          "time in which layers, tables and slow inputs fade over"),
    ABOVE(SECTION_CORRECTION, "reversal_fade_s", SCALE_NONE, IN_SETUP(machine.correction.reversal_fade_s), 0, 60,
          "the same of directions of approach, when an axis reverses"),
    FROM(SECTION_CORRECTION, "reserve_ratio", SCALE_NONE, IN_SETUP(machine.correction.reserve_ratio), 0, 0.5,
         "part of the axes' limits kept for correction at least, so that tables can be loaded while running"),

    ERRORS("x", 0),
    ERRORS("y", 1),
    ERRORS("z", 2),
    ERRORS("_table", DEVIATION_TABLE),
    OF_GEOMETRY("squareness_urad", squareness_urad, 3, "squareness of Y to X about Z, of Z to X about Y, of Z to Y about X"),
    OF_GEOMETRY("tool_mm", tool_mm, 3, "from spindle nose to tool point: the arm of the rotations"),
    OF_GEOMETRY("tool_direction", tool_direction, 3,
                "from the tool's point into its spindle, of any length, with head_axis at 0: along it the tool wears"),
    CHOICE(SECTION_GEOMETRY, "head_axis", KEY_AXIS, IN_SETUP(geometry.head_axis),
           "rotary axis whose head turns the tool; none"),
    VECTOR(SECTION_GEOMETRY, "backlash_um", SCALE_NONE, IN_SETUP(geometry.backlash_um), 3, 0, 1e4, "gap of X, Y, Z"),
    CHOICE(SECTION_GEOMETRY, "table_axis", KEY_AXIS, IN_SETUP(geometry.table_axis),
           "rotary axis whose table turns the part; none"),
    OF_GEOMETRY("table_yaw", table_yaw, DEVIATION_CURVE_NUMBERS,
                "error of its angle: urad per 1000 deg, bow urad, sine urad, its wavelength deg, its phase deg"),
    OF_GEOMETRY("table_centre_mm", table_centre_mm, 3, "point of its axis"),
    VECTOR(SECTION_GEOMETRY, "growth_um_per_m_k", SCALE_NONE, IN_SETUP(geometry.growth_um_per_m_k), 3, -1e4, 1e4,
           "with temperature: X, Y, Z"),
    OF_GEOMETRY("growth_reference_mm", growth_reference_mm, 3, "where nothing moves"),
    OF_VIBRATION("mode_x", AXIS_X, "how X swings between motor and tool: frequency Hz, damping ratio, part of it that the tool sees (1: all); and the same of a second mode"),
    OF_VIBRATION("mode_y", AXIS_Y, "likewise"),
    OF_VIBRATION("mode_z", AXIS_Z, "likewise"),
    VECTOR(SECTION_GEOMETRY, "mode_uncertainty_percent", SCALE_NONE, IN_SETUP(vibration.uncertain_percent), AXIS_LINEAR_COUNT, 0, 50,
           "by so much the frequencies of X, Y, Z may be others: what is planned ahead keeps the tool within 3 P then; 0: they are known"),
    OF_SWING("x", AXIS_X),
    OF_SWING("y", AXIS_Y),
    OF_SWING("z", AXIS_Z),
    FROM(SECTION_GEOMETRY, "warming_k", SCALE_NONE, IN_SETUP(geometry.warming_k), -100, 100, "in the end"),
    FROM(SECTION_GEOMETRY, "warming_time_s", SCALE_NONE, IN_SETUP(geometry.warming_time_s), 0, 1e6,
         "time constant; 0: warm from the start"),
    FROM(SECTION_GEOMETRY, "sensor_step_k", SCALE_NONE, IN_SETUP(geometry.sensor_step_k), 0, 10,
         "resolution of the temperature sensor the controller reads; 0: exact"),
    FROM(SECTION_GEOMETRY, "wear_along_um_per_m", SCALE_NONE, IN_SETUP(geometry.wear_along_um_per_m), 0, 1e4,
         "what the tool really loses of its length per metre of cut"),
    FROM(SECTION_GEOMETRY, "wear_along_um_per_min", SCALE_NONE, IN_SETUP(geometry.wear_along_um_per_min), 0, 1e4,
         "and per minute of cutting"),
};
/* clang-format on */

const size_t machine_keys_count = sizeof machine_keys / sizeof machine_keys[0];
_Static_assert(sizeof machine_keys / sizeof machine_keys[0] <= MACHINE_KEYS_MAX,
               "room for marks of all keys");
