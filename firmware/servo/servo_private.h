/*
 * Shared by the sources of a drive.
 */
#ifndef TAKT_SERVO_SERVO_PRIVATE_H
#define TAKT_SERVO_SERVO_PRIVATE_H

#include "canopen/emcy.h"
#include "canopen/time_stamp.h"
#include "servo/dictionary.h"
#include "servo/servo.h"

#define DRIVE_NEVER    UINT64_MAX
#define MILLISECOND_NS 1000000u

#define TORQUE_PER_RATED 1000.0      /* 6071, 6077: counts of the rated torque */
#define TIME_CONSUMED    0x80000000u /* object 1012 */

/* Groups of objects that are computed when they are asked for. */
enum drive_group {
    DRIVE_GROUP_STATUS = 1, /* 6041, 6061 */
    DRIVE_GROUP_POSITION = 2,
    DRIVE_GROUP_FOLLOWING = 4,
    DRIVE_GROUP_ERROR = 8, /* 603F: always up to date; its change is an event */
    DRIVE_GROUP_INPUTS = 16,
    DRIVE_GROUP_MODE = 32, /* 6061: the same */
    DRIVE_GROUP_REST = 64,
    DRIVE_GROUP_ALL = 127
};

/* What a write to an object sets off. */
enum drive_touch {
    DRIVE_TOUCH_CONTROLWORD = 1,
    DRIVE_TOUCH_MODE = 2,
    DRIVE_TOUCH_CLOCK = 4,
    DRIVE_TOUCH_PROBE = 8,
    DRIVE_TOUCH_TORQUE = 16
};

/* A frame that a meddler holds back counts as sent. */
bool takt_servo_send(struct servo *drive, enum servo_frame kind, const struct can_frame *frame);

/* ---- node.c ---- */

/* Which frames are looked at, after an identifier has changed. */
void takt_servo_set_filter(struct servo *drive);
/* Times have changed: look at all of them at the next step. */
void takt_servo_look_soon(struct servo *drive);

/* ---- nmt.c ---- */

void takt_servo_send_heartbeat(struct servo *drive, enum nmt_state state);
void takt_servo_restart_heartbeat(struct servo *drive);
void takt_servo_restart_consumer(struct servo *drive, unsigned i);
/* Object 1016: may it get this value now? */
uint32_t takt_servo_check_consumer(const struct servo *drive, const struct object_row *row,
                                   uint32_t value);
/* Frames of NMT, another node's heartbeat, and the question of a master that guards. */
void takt_servo_take_nmt(struct servo *drive, const struct can_frame *frame);
void takt_servo_take_heartbeat(struct servo *drive, const struct can_frame *frame);
void takt_servo_take_guard(struct servo *drive);
/* Objects 100C and 100D; 0: no guarding master is watched. */
uint32_t takt_servo_life_ms(const struct servo *drive);

/* -1: the motor turns the other way than the axis counts. */
static inline double servo_sign(const struct servo *drive)
{
    return drive->config.increments_per_mm < 0 ? -1 : 1;
}
/* Position units per mm of what has no sign: windows. */
static inline double servo_scale(const struct servo *drive)
{
    return drive->increments_per_mm < 0 ? -drive->increments_per_mm : drive->increments_per_mm;
}
/* Velocity units per mm/s, and units of acceleration per mm/s2. */
static inline double servo_velocity_scale(const struct servo *drive)
{
    const double units = drive->config.velocity_units_per_mm_s;
    return units > 0 ? units : servo_scale(drive);
}

/* Object 1013, by the drive's own clock. */
uint32_t takt_servo_high_resolution_us(const struct servo *drive);
void takt_servo_set_high_resolution_us(struct servo *drive, uint32_t now_us);
/* Object 2002: TIME as the drive's own clock has gone on since. */
struct time_stamp takt_servo_time_of_day(const struct servo *drive);

/* ---- errors.c ---- */

/* An error of the communication is there (8130, 8700), or all are gone (0). */
void takt_servo_set_communication_error(struct servo *drive, uint16_t code);
/* They are gone with the communication itself: nobody is told. */
void takt_servo_forget_communication_error(struct servo *drive);
void takt_servo_send_waiting_emergencies(struct servo *drive);
void takt_servo_clear_history(struct servo *drive);

/* ---- pdo.c, pdo_check.c ---- */

#define COB_NOT_VALID 0x80000000u
#define COB_NO_RTR    0x40000000u

/* Transmission types: up to this one by SYNC; 0 at the SYNC after an event. */
#define TYPE_SYNC_MAX  240
#define TYPE_EVENT_MIN 254

#define RPDO_PARAMETERS 0x1400
#define RPDO_MAPPING    0x1600
#define TPDO_PARAMETERS 0x1800
#define TPDO_MAPPING    0x1A00

/* Bytes of the longest frame that it takes and sends. */
unsigned takt_servo_longest_frame(const struct servo *drive);
/*
 * The row of a mapping entry, NULL for a dummy. False, and the abort code: there is no such object,
 * of that length, that may travel this way.
 */
bool takt_servo_find_mapped(const struct servo *drive, uint32_t entry, enum object_flag direction,
                            const struct object_row **row, uint32_t *code);
void takt_servo_update_pdos(struct servo *drive);
/* The one that this object, 1400 ... 1BFF, is about. */
void takt_servo_update_pdo(struct servo *drive, uint16_t index);
void takt_servo_start_pdos(struct servo *drive); /* operational has been entered */
void takt_servo_take_rpdo(struct servo *drive, const struct can_frame *frame);
void takt_servo_apply_held(struct servo *drive);
/* The TPDO that a remote frame asks for, if there is one that may be asked for. */
void takt_servo_take_remote(struct servo *drive, const struct can_frame *frame);
void takt_servo_send_synchronous(struct servo *drive, const struct can_frame *sync);
/* Sends what an event or a timer has made due. */
void takt_servo_send_due(struct servo *drive);
/* Notes the changes since the last call that are events. */
void takt_servo_note_events(struct servo *drive);
uint64_t takt_servo_next_pdo_ns(const struct servo *drive);
/* Objects 1400 ... 1BFF: may they get this value now? */
uint32_t takt_servo_check_pdo_write(const struct servo *drive, const struct object_row *row,
                                    uint32_t value);

/* ---- objects.c ---- */

/* Brings the computed objects of these groups up to date. */
void takt_servo_refresh_groups(struct servo *drive, unsigned groups);
uint32_t takt_servo_read_row(const struct servo *drive, const struct object_row *row);
void takt_servo_apply_touches(struct servo *drive, unsigned touches);
/* What has been stored is in force again, of the objects up to this index. */
void takt_servo_restore(struct servo *drive, uint16_t last);
uint32_t takt_servo_read_sdo(void *drive, uint32_t object, uint8_t number[4], const uint8_t **bytes,
                             size_t *length);
uint32_t takt_servo_may_write_sdo(void *drive, uint32_t object, size_t *size);
uint32_t takt_servo_write_sdo(void *drive, uint32_t object, const uint8_t *bytes, size_t length);

/* ---- settings.c ---- */

void takt_servo_init_objects(struct servo *drive);
/* What the position loop needs, from the settings. */
void takt_servo_derive(struct servo *drive);
/* What the loops need, from object 2020. */
void takt_servo_derive_loops(struct servo *drive);
void takt_servo_derive_torque(struct servo *drive);

/* ---- mechanics.c: what is taken back of the mechanics ---- */

/*
 * What of objects 2010 and 2011 the motor's readings are corrected by; they are so at once, and the
 * command with them.
 */
void takt_servo_derive_compensation(struct servo *drive);
/* Objects 2010 and 2011: may they get this value now? */
uint32_t takt_servo_check_compensation(const struct servo *drive, const struct object_row *row,
                                       uint32_t value);
/* The axis has been homed, or is so no more; origin_mm is what it is. */
void takt_servo_take_origin(struct servo *drive);
/* After a cycle: whether the axis has been told to turn back. */
void takt_servo_note_way(struct servo *drive);

/* ---- profile.c: states ---- */

/* Bits of object 1002. */
enum drive_status {
    DRIVE_STATUS_TORQUE_LIMIT = 1,
    DRIVE_STATUS_POSITION_LIMIT = 2, /* the target is beyond object 607D */
    DRIVE_STATUS_WARM = 4,
    DRIVE_STATUS_HOMED = 8,
    DRIVE_STATUS_PITCH = 16 /* the error of pitch is taken back */
};

uint32_t takt_servo_manufacturer_status(const struct servo *drive);
uint16_t takt_servo_statusword(const struct servo *drive);
void takt_servo_take_controlword(struct servo *drive, uint16_t controlword);
void takt_servo_take_mode(struct servo *drive, int8_t mode);
bool takt_servo_has_mode(const struct servo *drive, int8_t mode);
void takt_servo_move(struct servo *drive, uint32_t cycle_ns);
/* The connection to the controller is gone: object 6007 says what an enabled drive does. */
void takt_servo_lose_connection(struct servo *drive);
/* Back to the state after power-on; the motor runs out without torque. */
void takt_servo_reset_profile(struct servo *drive);

/* ---- io.c ---- */

void takt_servo_run_io(struct servo *drive); /* a cycle of an I/O node */

/* ---- modes.c: motion of the command while enabled ---- */

/* Position as the drive reports it: rounded to increments, held at the ends of the int32 range. */
int32_t takt_servo_increments(const struct servo *drive, double position_mm);
/* Where the encoder says the axis is, as a position of the drive. */
double takt_servo_actual_mm(const struct servo *drive);
/* From now on the command stands, or slows down to stand, until there is a new one. */
void takt_servo_hold(struct servo *drive);
void takt_servo_take_mode_controlword(struct servo *drive, uint16_t before, uint16_t controlword);
uint16_t takt_servo_mode_status(const struct servo *drive);
/* One cycle with torque. */
void takt_servo_run_mode(struct servo *drive, uint32_t cycle_ns);
/* One cycle of slowing down by deceleration. True: the command stands. */
bool takt_servo_slow(struct servo *drive, double deceleration_mm_s2, uint32_t cycle_ns);
double takt_servo_profile_acceleration_mm_s2(const struct servo *drive);
double takt_servo_profile_deceleration_mm_s2(const struct servo *drive);
/* The most that profiles may drive, by 607F and 6080, and the motor by 6080. */
double takt_servo_profile_velocity_max_mm_s(const struct servo *drive);
double takt_servo_motor_velocity_max_mm_s(const struct servo *drive);
/* Has it been within the window of the target for the time of that? Notes it. */
void takt_servo_note_reached(struct servo *drive, bool is_inside, uint16_t time_ms,
                             uint32_t cycle_ns);
/* Velocity and torque that are added (60B1, 60B2). */
void takt_servo_set_offsets(struct servo *drive);

/* ---- speed.c: modes of velocity and torque ---- */

void takt_servo_run_profile_velocity(struct servo *drive, uint32_t cycle_ns);
void takt_servo_run_cyclic_velocity(struct servo *drive, uint32_t cycle_ns);
void takt_servo_run_profile_torque(struct servo *drive, uint32_t cycle_ns);
void takt_servo_run_cyclic_torque(struct servo *drive, uint32_t cycle_ns);
/* Moves the command towards a velocity. */
void takt_servo_run_at(struct servo *drive, double velocity_mm_s, double acceleration_mm_s2,
                       uint32_t cycle_ns);

/* ---- homing.c ---- */

bool takt_servo_has_homing_method(int32_t method);
void takt_servo_begin_homing(struct servo *drive);
void takt_servo_interrupt_homing(struct servo *drive);
void takt_servo_run_homing(struct servo *drive, uint32_t cycle_ns);
uint32_t takt_servo_inputs(const struct servo *drive); /* 60FD */

/* ---- lss.c: layer setting services ---- */

#define LSS_REQUEST_COB_ID 0x7E5
#define LSS_ANSWER_COB_ID  0x7E4
#define LSS_NO_NODE        255

void takt_servo_take_lss(struct servo *drive, const struct can_frame *frame);
/* At a reset. */
void takt_servo_apply_lss(struct servo *drive, bool whole_node);

/* ---- probe.c: touch probes ---- */

/* Object 60B8 has been written. */
void takt_servo_take_probe_function(struct servo *drive);
/* Around a cycle of the motor: where it begins; index pulses that have been passed. */
void takt_servo_begin_probe(struct servo *drive);
void takt_servo_run_probe(struct servo *drive);

#endif
