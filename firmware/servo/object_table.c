#include "servo/dictionary.h"

#include <string.h>

#define NODE  OBJECT_NODE_ID
#define TPDO  OBJECT_TO_TPDO
#define RPDO  OBJECT_TO_RPDO
#define EVENT OBJECT_EVENT
#define OWN   OBJECT_BY_MACHINE

#define I8  OBJECT_INTEGER8
#define I16 OBJECT_INTEGER16
#define I32 OBJECT_INTEGER32
#define U8  OBJECT_UNSIGNED8
#define U16 OBJECT_UNSIGNED16
#define U32 OBJECT_UNSIGNED32

#define RO OBJECT_RO
#define RW OBJECT_RW
#define WO OBJECT_WO

#define PROCESS(field)  offsetof(struct drive_objects, process.field)
#define COM(field)      offsetof(struct drive_objects, communication.field)
#define SET(field)      offsetof(struct drive_objects, settings.field)
#define IDENTITY(field) offsetof(struct drive_objects, identity.field)
#define EXTRA(byte)     (offsetof(struct drive_objects, extra) + (byte))

#define COM_BEGIN offsetof(struct drive_objects, communication)

#define ROW(index, sub, kind, type, access, flags, field, initial, min, max, name, title)          \
    {                                                                                              \
        index, sub, kind, type, access, flags, (uint16_t)(field), initial, min, max, name, title   \
    }

/* An index by itself; the same with limits; one whose value never changes. */
#define VAR(index, type, access, flags, field, initial, name)                                      \
    ROW(index, 0, OBJECT_VAR, type, access, flags, field, initial, 0, 0, name, NULL)
#define VARL(index, type, access, flags, field, initial, min, max, name)                           \
    ROW(index, 0, OBJECT_VAR, type, access, (flags) | OBJECT_LIMITED, field, initial, min, max,    \
        name, NULL)
#define CONST(index, type, value, name)                                                            \
    ROW(index, 0, OBJECT_VAR, type, OBJECT_CONST, OBJECT_FIXED, 0, value, 0, 0, name, NULL)
#define TEXT(index, text, name)                                                                    \
    ROW(index, 0, OBJECT_VAR, OBJECT_STRING, OBJECT_CONST, OBJECT_FIXED, 0, 0, 0, 0, name, text)

/* An index with sub-indices: its head, then those. */
#define HEAD(index, kind, count, title)                                                            \
    ROW(index, 0, kind, U8, OBJECT_CONST, OBJECT_FIXED, 0, count, 0, 0,                            \
        "Highest sub-index supported", title)
#define SUB(index, sub, type, access, flags, field, initial, name)                                 \
    ROW(index, sub, OBJECT_SAME, type, access, flags, field, initial, 0, 0, name, NULL)
#define SUBL(index, sub, type, access, flags, field, initial, min, max, name)                      \
    ROW(index, sub, OBJECT_SAME, type, access, (flags) | OBJECT_LIMITED, field, initial, min, max, \
        name, NULL)
#define SUBC(index, sub, value, name)                                                              \
    ROW(index, sub, OBJECT_SAME, U32, RO, OBJECT_FIXED, 0, value, 0, 0, name, NULL)

#define RPDO_PARAMETERS(n, number, id, when)                                                       \
    HEAD(0x1400 + (n), OBJECT_RECORD, 2, "RPDO communication parameter " number),                  \
        SUB(0x1400 + (n), 1, U32, RW, NODE, COM(rpdo[n].cob_id), id, "COB-ID"),                    \
        SUB(0x1400 + (n), 2, U8, RW, 0, COM(rpdo[n].transmission), when, "Transmission type")

#define TPDO_PARAMETERS(n, number, id, when, milliseconds)                                         \
    HEAD(0x1800 + (n), OBJECT_RECORD, 6, "TPDO communication parameter " number),                  \
        SUB(0x1800 + (n), 1, U32, RW, NODE, COM(tpdo[n].cob_id), id, "COB-ID"),                    \
        SUB(0x1800 + (n), 2, U8, RW, 0, COM(tpdo[n].transmission), when, "Transmission type"),     \
        SUB(0x1800 + (n), 3, U16, RW, 0, COM(tpdo[n].inhibit_100us), 0, "Inhibit time"),           \
        SUB(0x1800 + (n), 5, U16, RW, 0, COM(tpdo[n].event_ms), milliseconds, "Event timer"),      \
        SUBL(0x1800 + (n), 6, U8, RW, 0, COM(tpdo[n].sync_start), 0, 0, 240, "SYNC start value")

/* Where mapping n begins, and entry i of it. */
#define MAPPING_OF(direction, n)                                                                   \
    (offsetof(struct drive_communication, direction##_mapping) +                                   \
     (n) * sizeof(struct drive_pdo_mapping) + COM_BEGIN)
#define ENTRY(i) (offsetof(struct drive_pdo_mapping, entry) + (i) * sizeof(uint32_t))

#define MAPPED(index, number, mapping, value)                                                      \
    SUB(index, number, U32, RW, 0, (mapping) + ENTRY((number)-1), value, "Mapped object " #number)

#define MAPPING(index, mapping, title, used, first, second)                                        \
    ROW(index, 0, OBJECT_RECORD, U8, RW, OBJECT_LIMITED,                                           \
        (mapping) + offsetof(struct drive_pdo_mapping, count), used, 0, DRIVE_PDO_MAPPED_MAX,      \
        "Number of mapped objects", title),                                                        \
        MAPPED(index, 1, mapping, first), MAPPED(index, 2, mapping, second),                       \
        MAPPED(index, 3, mapping, 0), MAPPED(index, 4, mapping, 0), MAPPED(index, 5, mapping, 0),  \
        MAPPED(index, 6, mapping, 0), MAPPED(index, 7, mapping, 0), MAPPED(index, 8, mapping, 0)

#define RPDO_MAPPING(n, number, used, first, second)                                               \
    MAPPING(0x1600 + (n), MAPPING_OF(rpdo, n), "RPDO mapping parameter " number, used, first,      \
            second)
#define TPDO_MAPPING(n, number, used, first, second)                                               \
    MAPPING(0x1A00 + (n), MAPPING_OF(tpdo, n), "TPDO mapping parameter " number, used, first,      \
            second)

#define HISTORY(number)                                                                            \
    SUB(0x1003, number, U32, RO, 0, PROCESS(history[(number)-1]), 0, "Error " #number)

#define METHOD(number, method)                                                                     \
    ROW(0x60E3, number, OBJECT_SAME, I8, RO, OBJECT_FIXED, 0, method, 0, 0, "Method " #number, NULL)

#define PITCH(number)                                                                              \
    SUB(0x2011, number, I32, RW, 0, SET(pitch_nm[(number)-1]), 0, "Error at point " #number)

#define BACKLASH_MAX_NM 10000000 /* more is no play but a broken coupling */

#define NOT_VALID 0x80000000
#define NO_RTR    0x40000000

/* clang-format off */
const struct object_row takt_object_table[] = {
    CONST(0x1000, U32, 0x00020192, "Device type"),
    VAR(0x1001, U8, RO, TPDO, PROCESS(error_register), 0, "Error register"),
    VAR(0x1002, U32, RO, TPDO, PROCESS(manufacturer_status), 0, "Manufacturer status register"),
    ROW(0x1003, 0, OBJECT_ARRAY, U8, RW, OBJECT_LIMITED, PROCESS(history_count), 0, 0, 0, "Number of errors", "Pre-defined error field"),
    HISTORY(1), HISTORY(2), HISTORY(3), HISTORY(4), HISTORY(5), HISTORY(6), HISTORY(7), HISTORY(8),
    VAR(0x1005, U32, RW, 0, COM(sync_cob_id), 0x80, "COB-ID SYNC message"),
    VAR(0x1006, U32, RW, 0, COM(sync_period_us), 0, "Communication cycle period"),
    VAR(0x1007, U32, RW, 0, COM(sync_window_us), 0, "Synchronous window length"),
    TEXT(0x1008, "takt CiA 402 drive", "Manufacturer device name"),
    TEXT(0x1009, "1", "Manufacturer hardware version"),
    TEXT(0x100A, "1.0", "Manufacturer software version"),
    VAR(0x100C, U16, RW, 0, COM(guard_ms), 0, "Guard time"),
    VAR(0x100D, U8, RW, 0, COM(life_factor), 0, "Life time factor"),
    HEAD(0x1010, OBJECT_ARRAY, 1, "Store parameters"),
    SUB(0x1010, 1, U32, RW, 0, PROCESS(store), 1, "Save all parameters"),
    HEAD(0x1011, OBJECT_ARRAY, 1, "Restore default parameters"),
    SUB(0x1011, 1, U32, RW, 0, PROCESS(restore), 1, "Restore all default parameters"),
    VAR(0x1012, U32, RW, 0, COM(time_cob_id), 0x100, "COB-ID time stamp object"),
    VAR(0x1013, U32, RW, TPDO | RPDO, PROCESS(high_resolution_us), 0, "High resolution time stamp"),
    VAR(0x1014, U32, RW, NODE, COM(emcy_cob_id), 0x80, "COB-ID EMCY"),
    VAR(0x1015, U16, RW, 0, COM(emcy_inhibit_100us), 0, "Inhibit time EMCY"),
    HEAD(0x1016, OBJECT_ARRAY, DRIVE_CONSUMERS, "Consumer heartbeat time"),
    SUB(0x1016, 1, U32, RW, 0, COM(consumer_heartbeat[0]), 0, "Node and time 1"),
    SUB(0x1016, 2, U32, RW, 0, COM(consumer_heartbeat[1]), 0, "Node and time 2"),
    VAR(0x1017, U16, RW, 0, COM(producer_heartbeat_ms), 0, "Producer heartbeat time"),
    HEAD(0x1018, OBJECT_RECORD, 4, "Identity object"),
    SUBC(0x1018, 1, 0, "Vendor-ID"),
    SUBC(0x1018, 2, 0x402, "Product code"),
    SUBC(0x1018, 3, 0x10000, "Revision number"),
    SUB(0x1018, 4, U32, RO, OWN, IDENTITY(serial), 0, "Serial number"),
    VARL(0x1019, U8, RW, 0, COM(sync_overflow), 0, 0, 240, "Synchronous counter overflow value"),
    ROW(0x1021, 0, OBJECT_VAR, OBJECT_DOMAIN, RO, OBJECT_FIXED, 0, 0, 0, 0, "Store EDS", NULL),
    CONST(0x1022, U16, 0, "Store format"),
    HEAD(0x1029, OBJECT_ARRAY, 1, "Error behaviour"),
    SUBL(0x1029, 1, U8, RW, 0, COM(error_behaviour), 0, 0, 2, "Communication error"),
    HEAD(0x1200, OBJECT_RECORD, 2, "SDO server parameter"),
    SUB(0x1200, 1, U32, RO, NODE, IDENTITY(sdo_cob_id[0]), 0x600, "COB-ID client to server"),
    SUB(0x1200, 2, U32, RO, NODE, IDENTITY(sdo_cob_id[1]), 0x580, "COB-ID server to client"),

    RPDO_PARAMETERS(0, "1", 0x200, 255),
    RPDO_PARAMETERS(1, "2", 0x300, 1),
    RPDO_PARAMETERS(2, "3", NOT_VALID | 0x400, 255),
    RPDO_PARAMETERS(3, "4", NOT_VALID | 0x500, 1),
    RPDO_MAPPING(0, "1", 2, 0x60400010, 0x60600008),
    RPDO_MAPPING(1, "2", 1, 0x607A0020, 0),
    RPDO_MAPPING(2, "3", 2, 0x60400010, 0x607A0020),
    RPDO_MAPPING(3, "4", 1, 0x60C10120, 0),
    TPDO_PARAMETERS(0, "1", NO_RTR | 0x180, 1, 0),
    TPDO_PARAMETERS(1, "2", NO_RTR | 0x280, 255, 100),
    TPDO_PARAMETERS(2, "3", NOT_VALID | NO_RTR | 0x380, 255, 0),
    TPDO_PARAMETERS(3, "4", NOT_VALID | NO_RTR | 0x480, 1, 0),
    TPDO_MAPPING(0, "1", 2, 0x60410010, 0x60640020),
    TPDO_MAPPING(1, "2", 2, 0x603F0010, 0x60F40020),
    TPDO_MAPPING(2, "3", 2, 0x60410010, 0x60610008),
    TPDO_MAPPING(3, "4", 2, 0x606C0020, 0x60770010),

    VAR(0x2000, OBJECT_STRING, RW, 0, SET(label), 0, "Name of the axis"),
    VAR(0x2001, OBJECT_DOMAIN, RW, 0, PROCESS(notes), 0, "Notes"),
    HEAD(0x2002, OBJECT_RECORD, 2, "Time of day"),
    SUB(0x2002, 1, U32, RO, TPDO, PROCESS(time_ms), 0, "Milliseconds since midnight"),
    SUB(0x2002, 2, U16, RO, TPDO, PROCESS(time_days), 0, "Days since 1984"),
    VAR(0x2003, U16, RW, 0, SET(homing_torque), 1000, "Torque at a hard stop"),
    HEAD(0x2010, OBJECT_RECORD, 4, "Error of pitch and backlash"),
    SUBL(0x2010, 1, U8, RW, 0, SET(pitch_points), 0, 0, DRIVE_PITCH_POINTS, "Number of points"),
    SUB(0x2010, 2, I32, RW, 0, SET(pitch_first), 0, "Position of the first point"),
    SUBL(0x2010, 3, U32, RW, 0, SET(pitch_distance), 1, 1, UINT32_MAX, "Distance of points"),
    SUBL(0x2010, 4, U32, RW, 0, SET(backlash_nm), 0, 0, BACKLASH_MAX_NM, "Backlash"),
    HEAD(0x2011, OBJECT_ARRAY, DRIVE_PITCH_POINTS, "Error of pitch"),
    PITCH(1), PITCH(2), PITCH(3), PITCH(4), PITCH(5), PITCH(6), PITCH(7), PITCH(8),
    PITCH(9), PITCH(10), PITCH(11), PITCH(12), PITCH(13), PITCH(14), PITCH(15), PITCH(16),
    PITCH(17), PITCH(18), PITCH(19), PITCH(20), PITCH(21), PITCH(22), PITCH(23), PITCH(24),
    PITCH(25), PITCH(26), PITCH(27), PITCH(28), PITCH(29), PITCH(30), PITCH(31), PITCH(32),
    PITCH(33), PITCH(34), PITCH(35), PITCH(36), PITCH(37), PITCH(38), PITCH(39), PITCH(40),
    PITCH(41), PITCH(42), PITCH(43), PITCH(44), PITCH(45), PITCH(46), PITCH(47), PITCH(48),
    PITCH(49), PITCH(50), PITCH(51), PITCH(52), PITCH(53), PITCH(54), PITCH(55), PITCH(56),
    PITCH(57), PITCH(58), PITCH(59), PITCH(60), PITCH(61), PITCH(62), PITCH(63), PITCH(64),

    HEAD(0x2020, OBJECT_RECORD, 6, "Loops"),
    SUBL(0x2020, 1, U32, RW, OWN, SET(told_inertia), 1, 1, UINT32_MAX, "Inertia"),
    SUBL(0x2020, 2, U32, RW, OWN, SET(velocity_bandwidth), 1, 1, UINT32_MAX, "Bandwidth of velocity loop"),
    SUB(0x2020, 3, U32, RW, OWN, SET(velocity_integral), 0, "Integral time of velocity loop"),
    SUBL(0x2020, 4, U32, RW, OWN, SET(position_gain), 1, 1, UINT32_MAX, "Position gain"),
    SUBL(0x2020, 5, U16, RW, OWN, SET(velocity_feed_forward), 0, 0, 1000, "Velocity feed-forward"),
    SUBL(0x2020, 6, U16, RW, OWN, SET(torque_feed_forward), 0, 0, 1000, "Torque feed-forward"),
    VARL(0x6007, I16, RW, 0, SET(abort_connection_option), 3, 0, 3, "Abort connection option code"),
    VAR(0x603F, U16, RO, TPDO | EVENT, PROCESS(error_code), 0, "Error code"),
    VAR(0x6040, U16, RW, RPDO, PROCESS(controlword), 0, "Controlword"),
    VAR(0x6041, U16, RO, TPDO | EVENT, PROCESS(statusword), 0, "Statusword"),
    VARL(0x605A, I16, RW, 0, SET(quick_stop_option), 2, 0, 6, "Quick stop option code"),
    VARL(0x605B, I16, RW, 0, SET(shutdown_option), 0, 0, 1, "Shutdown option code"),
    VARL(0x605C, I16, RW, 0, SET(disable_option), 1, 0, 1, "Disable operation option code"),
    VARL(0x605D, I16, RW, 0, SET(halt_option), 1, 1, 2, "Halt option code"),
    VARL(0x605E, I16, RW, 0, SET(fault_reaction_option), 2, 0, 2, "Fault reaction option code"),
    VAR(0x6060, I8, RW, RPDO, PROCESS(mode), 0, "Modes of operation"),
    VAR(0x6061, I8, RO, TPDO | EVENT, PROCESS(mode_display), 0, "Modes of operation display"),
    VAR(0x6062, I32, RO, TPDO, PROCESS(demand_position), 0, "Position demand value"),
    VAR(0x6063, I32, RO, TPDO, PROCESS(actual_internal), 0, "Position actual internal value"),
    VAR(0x6064, I32, RO, TPDO, PROCESS(actual_position), 0, "Position actual value"),
    VAR(0x6065, U32, RW, OWN, SET(following_window), 0, "Following error window"),
    VAR(0x6066, U16, RW, OWN, SET(following_timeout_ms), 0, "Following error time out"),
    VAR(0x6067, U32, RW, OWN, SET(position_window), 0, "Position window"),
    VAR(0x6068, U16, RW, 0, SET(position_window_ms), 10, "Position window time"),
    VAR(0x606B, I32, RO, TPDO, PROCESS(demand_velocity), 0, "Velocity demand value"),
    VAR(0x606C, I32, RO, TPDO, PROCESS(actual_velocity), 0, "Velocity actual value"),
    VAR(0x606D, U16, RW, OWN, SET(velocity_window), 0, "Velocity window"),
    VAR(0x606E, U16, RW, 0, SET(velocity_window_ms), 10, "Velocity window time"),
    VAR(0x606F, U16, RW, OWN, SET(velocity_threshold), 0, "Velocity threshold"),
    VAR(0x6071, I16, RW, RPDO, PROCESS(target_torque), 0, "Target torque"),
    VAR(0x6072, U16, RW, OWN | RPDO, SET(max_torque), 0, "Max torque"),
    VAR(0x6074, I16, RO, TPDO, PROCESS(demand_torque), 0, "Torque demand"),
    VAR(0x6077, I16, RO, TPDO, PROCESS(actual_torque), 0, "Torque actual value"),
    VAR(0x607A, I32, RW, RPDO, PROCESS(target_position), 0, "Target position"),
    VAR(0x607C, I32, RW, 0, SET(home_offset), 0, "Home offset"),
    HEAD(0x607D, OBJECT_ARRAY, 2, "Software position limit"),
    SUB(0x607D, 1, I32, RW, 0, SET(position_limit[0]), INT32_MIN, "Min position limit"),
    SUB(0x607D, 2, I32, RW, 0, SET(position_limit[1]), INT32_MAX, "Max position limit"),
    VAR(0x607E, U8, RW, 0, SET(polarity), 0, "Polarity"),
    VARL(0x607F, U32, RW, OWN, SET(max_profile_velocity), 1, 1, UINT32_MAX, "Max profile velocity"),
    VARL(0x6080, U32, RW, 0, SET(max_motor_speed_rpm), 3000, 1, UINT32_MAX, "Max motor speed"),
    VARL(0x6081, U32, RW, OWN | RPDO, SET(profile_velocity), 1, 1, UINT32_MAX, "Profile velocity"),
    VAR(0x6082, U32, RW, OWN, SET(end_velocity), 0, "End velocity"),
    VARL(0x6083, U32, RW, OWN, SET(profile_acceleration), 1, 1, UINT32_MAX, "Profile acceleration"),
    VARL(0x6084, U32, RW, OWN, SET(profile_deceleration), 1, 1, UINT32_MAX, "Profile deceleration"),
    VARL(0x6085, U32, RW, OWN, SET(quick_stop_deceleration), 1, 1, UINT32_MAX, "Quick stop deceleration"),
    VARL(0x6086, I16, RW, 0, SET(motion_profile_type), 0, 0, 3, "Motion profile type"),
    VARL(0x6087, U32, RW, 0, SET(torque_slope), 10000, 1, UINT32_MAX, "Torque slope"),
    VARL(0x6088, I16, RW, 0, SET(torque_profile_type), 0, 0, 0, "Torque profile type"),
    HEAD(0x608F, OBJECT_ARRAY, 2, "Position encoder resolution"),
    SUB(0x608F, 1, U32, RO, OWN, IDENTITY(encoder_counts), 0, "Encoder increments"),
    SUBC(0x608F, 2, 1, "Motor revolutions"),
    HEAD(0x6091, OBJECT_ARRAY, 2, "Gear ratio"),
    SUBL(0x6091, 1, U32, RW, 0, SET(gear_motor), 1, 1, UINT32_MAX, "Motor revolutions"),
    SUBL(0x6091, 2, U32, RW, 0, SET(gear_shaft), 1, 1, UINT32_MAX, "Shaft revolutions"),
    HEAD(0x6092, OBJECT_ARRAY, 2, "Feed constant"),
    SUBL(0x6092, 1, U32, RW, OWN, SET(feed_increments), 1, 1, UINT32_MAX, "Feed"),
    SUBL(0x6092, 2, U32, RW, 0, SET(feed_shaft), 1, 1, UINT32_MAX, "Shaft revolutions"),
    VAR(0x6098, I8, RW, 0, SET(homing_method), 37, "Homing method"),
    HEAD(0x6099, OBJECT_ARRAY, 2, "Homing speeds"),
    SUBL(0x6099, 1, U32, RW, OWN, SET(homing_velocity[0]), 1, 1, UINT32_MAX, "Speed during search for switch"),
    SUBL(0x6099, 2, U32, RW, OWN, SET(homing_velocity[1]), 1, 1, UINT32_MAX, "Speed during search for zero"),
    VARL(0x609A, U32, RW, OWN, SET(homing_acceleration), 1, 1, UINT32_MAX, "Homing acceleration"),
    HEAD(0x60A4, OBJECT_ARRAY, 1, "Profile jerk"),
    SUBL(0x60A4, 1, U32, RW, OWN, SET(profile_jerk), 1, 1, UINT32_MAX, "Profile jerk 1"),
    VAR(0x60B0, I32, RW, RPDO, PROCESS(position_offset), 0, "Position offset"),
    VAR(0x60B1, I32, RW, RPDO, PROCESS(velocity_offset), 0, "Velocity offset"),
    VAR(0x60B2, I16, RW, RPDO, PROCESS(torque_offset), 0, "Torque offset"),
    VAR(0x60B8, U16, RW, RPDO, PROCESS(probe_function), 0, "Touch probe function"),
    VAR(0x60B9, U16, RO, TPDO, PROCESS(probe_status), 0, "Touch probe status"),
    VAR(0x60BA, I32, RO, TPDO, PROCESS(probe_latched[0]), 0, "Touch probe 1 positive edge"),
    VAR(0x60BB, I32, RO, TPDO, PROCESS(probe_latched[1]), 0, "Touch probe 1 negative edge"),
    VAR(0x60BC, I32, RO, TPDO, PROCESS(probe_latched[2]), 0, "Touch probe 2 positive edge"),
    VAR(0x60BD, I32, RO, TPDO, PROCESS(probe_latched[3]), 0, "Touch probe 2 negative edge"),
    VARL(0x60C0, I16, RW, 0, SET(interpolation_submode), 0, -1, 0, "Interpolation sub mode select"),
    HEAD(0x60C1, OBJECT_ARRAY, 1, "Interpolation data record"),
    SUB(0x60C1, 1, I32, RW, RPDO, PROCESS(interpolation_target), 0, "Set-point"),
    HEAD(0x60C2, OBJECT_RECORD, 2, "Interpolation time period"),
    SUBL(0x60C2, 1, U8, RW, OWN, SET(interpolation_period), 1, 1, 255, "Interpolation time period value"),
    SUBL(0x60C2, 2, I8, RW, OWN, SET(interpolation_index), -3, -6, 0, "Interpolation time index"),
    HEAD(0x60C4, OBJECT_RECORD, 6, "Interpolation data configuration"),
    SUBC(0x60C4, 1, 1, "Maximum buffer size"),
    SUBL(0x60C4, 2, U32, RW, 0, PROCESS(buffer_size), 1, 1, 1, "Actual buffer size"),
    SUBL(0x60C4, 3, U8, RW, 0, SET(buffer_organisation), 0, 0, 1, "Buffer organisation"),
    SUBL(0x60C4, 4, U16, RW, 0, SET(buffer_position), 0, 0, 0, "Buffer position"),
    ROW(0x60C4, 5, OBJECT_SAME, U8, WO, OBJECT_LIMITED | OBJECT_FIXED, 0, 4, 4, 4, "Size of data record", NULL),
    SUBL(0x60C4, 6, U8, WO, 0, PROCESS(buffer_clear), 0, 0, 1, "Buffer clear"),
    VARL(0x60C5, U32, RW, OWN, SET(max_acceleration), UINT32_MAX, 1, UINT32_MAX, "Max acceleration"),
    VARL(0x60C6, U32, RW, OWN, SET(max_deceleration), UINT32_MAX, 1, UINT32_MAX, "Max deceleration"),
    HEAD(0x60E3, OBJECT_ARRAY, 36, "Supported homing methods"),
    METHOD(1, -4), METHOD(2, -3), METHOD(3, -2), METHOD(4, -1), METHOD(5, 1), METHOD(6, 2), METHOD(7, 3),
    METHOD(8, 4), METHOD(9, 5), METHOD(10, 6), METHOD(11, 7), METHOD(12, 8), METHOD(13, 9), METHOD(14, 10),
    METHOD(15, 11), METHOD(16, 12), METHOD(17, 13), METHOD(18, 14), METHOD(19, 17), METHOD(20, 18),
    METHOD(21, 19), METHOD(22, 20), METHOD(23, 21), METHOD(24, 22), METHOD(25, 23), METHOD(26, 24),
    METHOD(27, 25), METHOD(28, 26), METHOD(29, 27), METHOD(30, 28), METHOD(31, 29), METHOD(32, 30),
    METHOD(33, 33), METHOD(34, 34), METHOD(35, 35), METHOD(36, 37),
    VAR(0x60F4, I32, RO, TPDO, PROCESS(following_error), 0, "Following error actual value"),
    VAR(0x60FD, U32, RO, TPDO | EVENT, PROCESS(digital_inputs), 0, "Digital inputs"),
    HEAD(0x60FE, OBJECT_ARRAY, 2, "Digital outputs"),
    SUB(0x60FE, 1, U32, RW, RPDO, PROCESS(digital_outputs), 0, "Physical outputs"),
    SUB(0x60FE, 2, U32, RW, 0, SET(output_mask), 0, "Bit mask"),
    VAR(0x60FF, I32, RW, RPDO, PROCESS(target_velocity), 0, "Target velocity"),
    CONST(0x6502, U32, 0x3ED, "Supported drive modes"),
};
/* clang-format on */

const unsigned takt_object_table_count = sizeof takt_object_table / sizeof takt_object_table[0];

const struct dictionary takt_dictionary_own = {
    .row = takt_object_table,
    .count = sizeof takt_object_table / sizeof takt_object_table[0],
    .dummies = 0xFC /* all whole numbers */
};

#define MAPPING_OF_4(index, mapping, title, first, second, third, fourth)                          \
    ROW(index, 0, OBJECT_RECORD, U8, RW, OBJECT_LIMITED,                                           \
        (mapping) + offsetof(struct drive_pdo_mapping, count), 4, 0, 4,                            \
        "Number of mapped objects", title),                                                        \
        MAPPED(index, 1, mapping, first), MAPPED(index, 2, mapping, second),                       \
        MAPPED(index, 3, mapping, third), MAPPED(index, 4, mapping, fourth)

#define ANALOGUE(number)                                                                           \
    SUB(0x6411, number, I16, RW, RPDO, EXTRA(2 * DICTIONARY_IO_BYTES + 2 * ((number)-1)), 0,       \
        "Analogue output " #number)

/* clang-format off */
static const struct object_row io_table[] = {
    CONST(0x1000, U32, 0x00030191, "Device type"),
    VAR(0x1001, U8, RO, TPDO, PROCESS(error_register), 0, "Error register"),
    VAR(0x1005, U32, RW, 0, COM(sync_cob_id), 0x80, "COB-ID SYNC message"),
    TEXT(0x1008, "takt CiA 401 I/O node", "Manufacturer device name"),
    VAR(0x100C, U16, RW, 0, COM(guard_ms), 0, "Guard time"),
    VAR(0x100D, U8, RW, 0, COM(life_factor), 0, "Life time factor"),
    VAR(0x1014, U32, RW, NODE, COM(emcy_cob_id), 0x80, "COB-ID EMCY"),
    HEAD(0x1016, OBJECT_ARRAY, DRIVE_CONSUMERS, "Consumer heartbeat time"),
    SUB(0x1016, 1, U32, RW, 0, COM(consumer_heartbeat[0]), 0, "Node and time 1"),
    SUB(0x1016, 2, U32, RW, 0, COM(consumer_heartbeat[1]), 0, "Node and time 2"),
    VAR(0x1017, U16, RW, 0, COM(producer_heartbeat_ms), 0, "Producer heartbeat time"),
    HEAD(0x1018, OBJECT_RECORD, 4, "Identity object"),
    SUBC(0x1018, 1, 0, "Vendor-ID"),
    SUBC(0x1018, 2, 0x401, "Product code"),
    SUBC(0x1018, 3, 0x10000, "Revision number"),
    SUB(0x1018, 4, U32, RO, OWN, IDENTITY(serial), 0, "Serial number"),
    RPDO_PARAMETERS(0, "1", 0x200, 255),
    RPDO_MAPPING(0, "1", DICTIONARY_IO_BYTES, 0x62000108, 0x62000208),
    RPDO_PARAMETERS(1, "2", 0x300, 255),
    MAPPING_OF_4(0x1601, MAPPING_OF(rpdo, 1), "RPDO mapping parameter 2", 0x64110110, 0x64110210, 0x64110310, 0x64110410),
    TPDO_PARAMETERS(0, "1", NO_RTR | 0x180, 255, 0),
    TPDO_MAPPING(0, "1", DICTIONARY_IO_BYTES, 0x60000108, 0x60000208),
    HEAD(0x6000, OBJECT_ARRAY, DICTIONARY_IO_BYTES, "Read input 8-bit"),
    SUB(0x6000, 1, U8, RO, TPDO, EXTRA(DICTIONARY_IO_BYTES), 0, "Inputs 1 to 8"),
    SUB(0x6000, 2, U8, RO, TPDO, EXTRA(DICTIONARY_IO_BYTES + 1), 0, "Inputs 9 to 16"),
    HEAD(0x6200, OBJECT_ARRAY, DICTIONARY_IO_BYTES, "Write output 8-bit"),
    SUB(0x6200, 1, U8, RW, RPDO, EXTRA(0), 0, "Outputs 1 to 8"),
    SUB(0x6200, 2, U8, RW, RPDO, EXTRA(1), 0, "Outputs 9 to 16"),
    HEAD(0x6411, OBJECT_ARRAY, DICTIONARY_IO_ANALOGUES, "Write analogue output 16-bit"),
    ANALOGUE(1), ANALOGUE(2), ANALOGUE(3), ANALOGUE(4),
};
/* clang-format on */

const struct dictionary takt_dictionary_io = {.row = io_table,
                                              .count = sizeof io_table / sizeof io_table[0]};

const struct object_row *takt_object_table_find(uint16_t index, uint8_t sub, bool *has_index)
{
    return takt_dictionary_find(&takt_dictionary_own, index, sub, has_index);
}

unsigned takt_object_type_bytes(enum object_type type)
{
    switch (type) {
    case OBJECT_INTEGER8:
    case OBJECT_UNSIGNED8:
        return 1;
    case OBJECT_INTEGER16:
    case OBJECT_UNSIGNED16:
        return 2;
    case OBJECT_INTEGER32:
    case OBJECT_UNSIGNED32:
        return 4;
    case OBJECT_STRING:
    case OBJECT_DOMAIN:
        break;
    }
    return 0;
}

int64_t takt_object_type_value(enum object_type type, uint32_t raw)
{
    switch (type) {
    case OBJECT_INTEGER8:
        return (int8_t)(uint8_t)raw;
    case OBJECT_INTEGER16:
        return (int16_t)(uint16_t)raw;
    case OBJECT_INTEGER32:
        return (int32_t)raw;
    case OBJECT_UNSIGNED8:
        return (uint8_t)raw;
    case OBJECT_UNSIGNED16:
        return (uint16_t)raw;
    case OBJECT_UNSIGNED32:
    case OBJECT_STRING:
    case OBJECT_DOMAIN:
        break;
    }
    return raw;
}

/* Fields have the width of their type; the copy goes through a number of that width. */
uint32_t takt_object_read(const struct object_row *row, const struct drive_objects *objects)
{
    const char *field = (const char *)objects + row->field;
    uint8_t one;
    uint16_t two;
    uint32_t four;
    if (row->flags & OBJECT_FIXED)
        return (uint32_t)row->initial;
    switch (takt_object_type_bytes(row->type)) {
    case 1:
        memcpy(&one, field, sizeof one);
        return one;
    case 2:
        memcpy(&two, field, sizeof two);
        return two;
    default:
        memcpy(&four, field, sizeof four);
        return four;
    }
}

void takt_object_write(const struct object_row *row, struct drive_objects *objects, uint32_t raw)
{
    char *field = (char *)objects + row->field;
    uint8_t one = (uint8_t)raw;
    uint16_t two = (uint16_t)raw;
    if (row->flags & OBJECT_FIXED)
        return;
    switch (takt_object_type_bytes(row->type)) {
    case 1:
        memcpy(field, &one, sizeof one);
        break;
    case 2:
        memcpy(field, &two, sizeof two);
        break;
    default:
        memcpy(field, &raw, sizeof raw);
        break;
    }
}
