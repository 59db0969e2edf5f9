/*
 * Shared by the sources of a virtual drive.
 */
#ifndef TAKT_DRIVES_VIRTUAL_DRIVE_PRIVATE_H
#define TAKT_DRIVES_VIRTUAL_DRIVE_PRIVATE_H

#include "canopen/emcy.h"
#include "canopen/time_stamp.h"
#include "drives/dictionary.h"
#include "drives/virtual_drive.h"

#define DRIVE_NEVER    UINT64_MAX
#define MILLISECOND_NS 1000000u

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

/* Kinds of frames a drive sends, for faults that hold them back. */
bool virtual_drive_send(struct virtual_drive *drive, enum inject_mute kind,
                        const struct can_frame *frame);

void virtual_drive_tell(const struct virtual_drive *drive, enum drive_event_kind kind,
                        uint32_t first, uint32_t second);

/* ---- virtual_drive.c: node ---- */

/* Which frames are looked at, after an identifier has changed. */
void virtual_drive_set_filter(struct virtual_drive *drive);
/* Times have changed: look at all of them at the next step. */
void virtual_drive_look_soon(struct virtual_drive *drive);
void virtual_drive_restart_heartbeat(struct virtual_drive *drive);
void virtual_drive_restart_consumer(struct virtual_drive *drive, unsigned i);

/* -1: the motor turns the other way than the axis counts. */
static inline double virtual_drive_sign(const struct virtual_drive *drive)
{
    return drive->config.increments_per_mm < 0 ? -1 : 1;
}
/* Position units per mm of what has no sign: windows. */
static inline double virtual_drive_scale(const struct virtual_drive *drive)
{
    return drive->increments_per_mm < 0 ? -drive->increments_per_mm : drive->increments_per_mm;
}
/* Velocity units per mm/s, and units of acceleration per mm/s2. */
static inline double virtual_drive_velocity_scale(const struct virtual_drive *drive)
{
    const double units = drive->config.velocity_units_per_mm_s;
    return units > 0 ? units : virtual_drive_scale(drive);
}

/* Object 1013, by the drive's own clock. */
uint32_t virtual_drive_high_resolution_us(const struct virtual_drive *drive);
void virtual_drive_set_high_resolution_us(struct virtual_drive *drive, uint32_t now_us);
/* Object 2002: TIME as the drive's own clock has gone on since. */
struct time_stamp virtual_drive_time_of_day(const struct virtual_drive *drive);

/* As after NMT's reset of the node. */
void virtual_drive_reboot(struct virtual_drive *drive);

/* ---- virtual_drive_errors.c ---- */

/* An error of the communication is there (8130, 8700), or all are gone (0). */
void virtual_drive_set_communication_error(struct virtual_drive *drive, uint16_t code);
/* Sends an emergency, notes it in the history. error_register: what it adds to 1001. */
void virtual_drive_send_emergency(struct virtual_drive *drive, uint16_t code,
                                  uint8_t error_register);
void virtual_drive_send_waiting_emergencies(struct virtual_drive *drive);
void virtual_drive_clear_history(struct virtual_drive *drive);

/* ---- virtual_drive_pdo.c ---- */

void virtual_drive_update_pdos(struct virtual_drive *drive);
/* The one that this object, 1400 ... 1BFF, is about. */
void virtual_drive_update_pdo(struct virtual_drive *drive, uint16_t index);
void virtual_drive_start_pdos(struct virtual_drive *drive); /* operational has been entered */
void virtual_drive_take_rpdo(struct virtual_drive *drive, const struct can_frame *frame);
void virtual_drive_apply_held(struct virtual_drive *drive);
void virtual_drive_send_synchronous(struct virtual_drive *drive, const struct can_frame *sync);
/* Sends what an event or a timer has made due. */
void virtual_drive_send_due(struct virtual_drive *drive);
/* Notes the changes since the last call that are events. */
void virtual_drive_note_events(struct virtual_drive *drive);
uint64_t virtual_drive_next_pdo_ns(const struct virtual_drive *drive);
/* Objects 1400 ... 1BFF: may they get this value now? */
uint32_t virtual_drive_check_pdo_write(const struct virtual_drive *drive,
                                       const struct object_row *row, uint32_t value);

/* ---- virtual_drive_objects.c ---- */

/* Brings the computed objects of these groups up to date. */
void virtual_drive_refresh(struct virtual_drive *drive, unsigned groups);
uint32_t virtual_drive_read_row(const struct virtual_drive *drive, const struct object_row *row);
void virtual_drive_apply_touches(struct virtual_drive *drive, unsigned touches);
/* What has been stored is in force again, of the objects up to this index. */
void virtual_drive_restore(struct virtual_drive *drive, uint16_t last);
uint32_t virtual_drive_read_sdo(void *drive, uint32_t object, uint8_t number[4],
                                const uint8_t **bytes, size_t *length);
uint32_t virtual_drive_may_write_sdo(void *drive, uint32_t object);
uint32_t virtual_drive_write_sdo(void *drive, uint32_t object, const uint8_t *bytes, size_t length);

/* ---- virtual_drive_settings.c ---- */

void virtual_drive_init_objects(struct virtual_drive *drive);
/* What the position loop needs, from the settings. */
void virtual_drive_derive(struct virtual_drive *drive);
void virtual_drive_derive_torque(struct virtual_drive *drive);

/* ---- virtual_drive_profile.c: states ---- */

/* Bits of object 1002. */
enum drive_status {
    DRIVE_STATUS_TORQUE_LIMIT = 1,
    DRIVE_STATUS_POSITION_LIMIT = 2, /* the target is beyond object 607D */
    DRIVE_STATUS_WARM = 4,
    DRIVE_STATUS_HOMED = 8
};

uint32_t virtual_drive_manufacturer_status(const struct virtual_drive *drive);
uint16_t virtual_drive_statusword(const struct virtual_drive *drive);
void virtual_drive_take_controlword(struct virtual_drive *drive, uint16_t controlword);
void virtual_drive_take_mode(struct virtual_drive *drive, int8_t mode);
bool virtual_drive_has_mode(const struct virtual_drive *drive, int8_t mode);
void virtual_drive_move(struct virtual_drive *drive, uint32_t cycle_ns);
/* The drive fails: emergency, fault reaction, fault. */
void virtual_drive_fail(struct virtual_drive *drive, uint16_t code, uint8_t error_register);
/* The connection to the controller is gone: object 6007 says what an enabled drive does. */
void virtual_drive_lose_connection(struct virtual_drive *drive);
/* Back to the state after power-on; the motor runs out without torque. */
void virtual_drive_reset_profile(struct virtual_drive *drive);

/* ---- virtual_drive_io.c ---- */

void virtual_drive_run_io(struct virtual_drive *drive); /* a cycle of an I/O node */

/* ---- virtual_drive_modes.c: motion of the command while enabled ---- */

/* Position as the drive reports it: rounded to increments, held at the ends of the int32 range. */
int32_t virtual_drive_increments(const struct virtual_drive *drive, double position_mm);
/* Where the encoder says the axis is, as a position of the drive. */
double virtual_drive_actual_mm(const struct virtual_drive *drive);
/* From now on the command stands, or slows down to stand, until there is a new one. */
void virtual_drive_hold(struct virtual_drive *drive);
void virtual_drive_take_mode_controlword(struct virtual_drive *drive, uint16_t before,
                                         uint16_t controlword);
uint16_t virtual_drive_mode_status(const struct virtual_drive *drive);
/* One cycle with torque. */
void virtual_drive_run_mode(struct virtual_drive *drive, uint32_t cycle_ns);
/* One cycle of slowing down by deceleration. True: the command stands. */
bool virtual_drive_slow(struct virtual_drive *drive, double deceleration_mm_s2, uint32_t cycle_ns);
double virtual_drive_profile_acceleration_mm_s2(const struct virtual_drive *drive);
double virtual_drive_profile_deceleration_mm_s2(const struct virtual_drive *drive);
/* The most that profiles may drive, by 607F and 6080, and the motor by 6080. */
double virtual_drive_profile_velocity_max_mm_s(const struct virtual_drive *drive);
double virtual_drive_motor_velocity_max_mm_s(const struct virtual_drive *drive);
/* Has it been within the window of the target for the time of that? Notes it. */
void virtual_drive_note_reached(struct virtual_drive *drive, bool is_inside, uint16_t time_ms,
                                uint32_t cycle_ns);
/* Value goes to goal, by so much at most. */
double virtual_drive_approach(double value, double goal, double by);
/* Velocity and torque that are added (60B1, 60B2). */
void virtual_drive_set_offsets(struct virtual_drive *drive);

/* ---- virtual_drive_speed.c: modes of velocity and torque ---- */

void virtual_drive_run_profile_velocity(struct virtual_drive *drive, uint32_t cycle_ns);
void virtual_drive_run_cyclic_velocity(struct virtual_drive *drive, uint32_t cycle_ns);
void virtual_drive_run_profile_torque(struct virtual_drive *drive, uint32_t cycle_ns);
void virtual_drive_run_cyclic_torque(struct virtual_drive *drive, uint32_t cycle_ns);
/* Moves the command towards a velocity. */
void virtual_drive_run_at(struct virtual_drive *drive, double velocity_mm_s,
                          double acceleration_mm_s2, uint32_t cycle_ns);

/* ---- virtual_drive_homing.c ---- */

bool virtual_drive_has_homing_method(int32_t method);
void virtual_drive_begin_homing(struct virtual_drive *drive);
void virtual_drive_interrupt_homing(struct virtual_drive *drive);
void virtual_drive_run_homing(struct virtual_drive *drive, uint32_t cycle_ns);
uint32_t virtual_drive_inputs(const struct virtual_drive *drive); /* 60FD */

/* ---- virtual_drive_lss.c: layer setting services ---- */

#define LSS_REQUEST_COB_ID 0x7E5
#define LSS_ANSWER_COB_ID  0x7E4
#define LSS_NO_NODE        255

void virtual_drive_take_lss(struct virtual_drive *drive, const struct can_frame *frame);
/* At a reset. */
void virtual_drive_apply_lss(struct virtual_drive *drive, bool whole_node);

/* ---- virtual_drive_probe.c: touch probes ---- */

/* Object 60B8 has been written. */
void virtual_drive_take_probe_function(struct virtual_drive *drive);
/* Around a cycle of the motor: where it begins; index pulses that have been passed. */
void virtual_drive_begin_probe(struct virtual_drive *drive);
void virtual_drive_run_probe(struct virtual_drive *drive);

/* ---- virtual_drive_faults.c ---- */

/* Begins and ends the scripted faults whose time has come. */
void virtual_drive_run_faults(struct virtual_drive *drive);
/* True: an SDO request for this object is to be aborted with *code. */
bool virtual_drive_aborts_sdo(const struct virtual_drive *drive, uint32_t object, uint32_t *code);
/* True: the object shows *value, whatever it holds. */
bool virtual_drive_overrides(const struct virtual_drive *drive, const struct object_row *row,
                             uint32_t *value);

#endif
