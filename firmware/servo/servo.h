/*
 * A servo drive: a CANopen node (CiA 301) with the drive profile CiA 402-2, its position and
 * velocity loop, and an I/O node (CiA 401) in its place. It knows ports, neither a bus nor a motor:
 * whoever owns it hands in the frames and the time.
 *
 * Modes of operation: profile position, velocity and torque, homing, interpolated position, cyclic
 * synchronous position, velocity and torque.
 */
#ifndef TAKT_SERVO_SERVO_H
#define TAKT_SERVO_SERVO_H

#include "canopen/cia402.h"
#include "canopen/emcy.h"
#include "canopen/nmt.h"
#include "canopen/pdo.h"
#include "canopen/sdo_server.h"
#include "canopen/time_stamp.h"
#include "hal/can.h"
#include "hal/motor.h"
#include "servo/compensation.h"
#include "servo/course.h"
#include "servo/dictionary.h"
#include "servo/drive_event.h"
#include "servo/drive_objects.h"
#include "servo/loop.h"
#include "servo/object_table.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct servo_config {
    uint8_t node; /* 1 ... 127 */
    bool is_fd;   /* its bus is CAN FD: PDOs of up to 64 bytes */
    /* no drive but an I/O node (CiA 401), of takt_dictionary_io: nothing of the motor counts */
    bool is_io;
    /* it has no node id before it gets one by LSS; node is then its serial number alone */
    bool is_nameless;
    bool is_absolute; /* the encoder knows the axis's position at power-on: it is homed */
    /* inputs of an I/O node that are high for good; the others are those of its outputs */
    uint16_t closed;
    /* position units of the drive per mm or rad; < 0: its motor turns the other way */
    double increments_per_mm;
    double velocity_units_per_mm_s; /* its units of velocity; 0: position units in a second */
    uint32_t cycle_us; /* between two targets at power-on (object 60C2); 0: a millisecond */
    uint32_t boot_us;  /* from a reset to the boot-up message */
    uint32_t sdo_us;   /* from a request to its answer */
    double following_error_window_mm;     /* object 6065: the drive faults beyond; 0: not watched */
    uint32_t following_error_timeout_ms;  /* object 6066: for longer than this */
    double quick_stop_deceleration_mm_s2; /* of quick stop and fault reaction (object 6085); > 0 */
    double temperature_max_c;             /* the drive faults beyond (EMCY 4310); 0: not watched */
    struct servo_loop_config loop;
    const struct dictionary *dictionary; /* must stay; NULL: takt's own */
};

/* Kinds of frames that a drive sends. */
enum servo_frame { SERVO_FRAME_HEARTBEAT, SERVO_FRAME_TPDO, SERVO_FRAME_SDO, SERVO_FRAME_EMCY };

/* What a test may make of a drive; each may be NULL. */
struct servo_meddler {
    /* True: the frame is not sent. */
    bool (*holds_back)(void *context, enum servo_frame kind);
    /* True: an SDO request for this object is to be aborted with *code. */
    bool (*aborts_sdo)(void *context, uint32_t object, uint32_t *code);
    /* True: the object shows *value, whatever it holds. */
    bool (*overrides)(void *context, const struct object_row *row, uint32_t *value);
    void *context;
};

struct servo;

#include "servo/servo_state.h"

/*
 * Switches the drive on; it has not booted yet. config is copied. target: its RPDO2, see
 * canopen/target_pdo.h; NULL: what the dictionary says. The ports must stay usable as long as the
 * drive; motor: NULL for an I/O node.
 */
void takt_servo_init(struct servo *drive, const struct servo_config *config,
                     const struct pdo *target, const struct can_port *port,
                     const struct motor_port *motor);

/* Both may be left out. eds: the text of object 1021; it must stay. */
void takt_servo_observe(struct servo *drive, const struct drive_observer *observer);
void takt_servo_set_eds(struct servo *drive, const char *eds, size_t length);

/*
 * Who is to keep what object 1010 stores, and 1011 takes back, beyond the drive's own life;
 * drive_store.h has a form for that. Without one it lives as long as the drive.
 */
void takt_servo_keep(struct servo *drive, const struct drive_keeper *keeper);

/* Copied. Without it nobody meddles. */
void takt_servo_meddle(struct servo *drive, const struct servo_meddler *meddler);

/* The power stage says that it fails: emergency, fault reaction, fault. */
void takt_servo_fail(struct servo *drive, uint16_t code, uint8_t error_register);
/*
 * Sends an emergency, notes it in the history, and goes on. error_register: what it adds to 1001.
 */
void takt_servo_send_emergency(struct servo *drive, uint16_t code, uint8_t error_register);
/* As NMT's reset of the node. */
void takt_servo_reboot(struct servo *drive);
/* Tells the observer. */
void takt_servo_tell(const struct servo *drive, enum drive_event_kind kind, uint32_t first,
                     uint32_t second);

/* Sends the boot-up message and enters the state pre-operational. */
void takt_servo_boot(struct servo *drive);

/* The drive listens to frames of this identifier: what a filter of the bus may let through. */
static inline bool servo_accepts(const struct servo *drive, const struct can_frame *frame)
{
    return can_passes(drive->accepts, frame->id);
}

/* A frame has come; the drive may send answers. */
void takt_servo_on_frame(struct servo *drive, const struct can_frame *frame);
/*
 * The same where the time on the bus is known: targets behind the window of object 1007 are none.
 */
void takt_servo_on_frame_at(struct servo *drive, const struct can_frame *frame, uint64_t time_ns);

/*
 * Time goes on by one cycle (> 0), which follows the SYNC just received: motor, supervision,
 * timers.
 */
void takt_servo_step(struct servo *drive, uint32_t cycle_ns);

/*
 * After a step: within it, when so much of it had passed, 0 ... 1, the input of the touch probes
 * became so. A level that it has already is no edge.
 */
void takt_servo_touch(struct servo *drive, bool touches, double ratio);
/* The position that the drive had then by its encoder, unrounded. */
double takt_servo_get_position_at_mm(const struct servo *drive, double ratio);

enum cia402_state takt_servo_get_state(const struct servo *drive);
enum nmt_state takt_servo_get_nmt_state(const struct servo *drive);
/* What the controller says of the time between two SYNCs, object 1006, else 60C2; 0: nothing. */
uint32_t takt_servo_get_sync_period_us(const struct servo *drive);

/*
 * The shortest time without a heartbeat (1016) or a guarding frame (100C) that it takes, ms; 0: it
 * watches none.
 */
uint32_t takt_servo_get_watched_ms(const struct servo *drive);

/* The frame is SYNC to this drive (object 1005). */
bool takt_servo_is_sync(const struct servo *drive, const struct can_frame *frame);

/* Brings all computed objects up to date. */
void takt_servo_refresh(struct servo *drive);

/*
 * Objects of the drive by their mapping entry (canopen/cia402.h), as raw bits. False: no such
 * object of that length; for write also one that cannot be written, or not to this value.
 */
bool takt_servo_read_object(struct servo *drive, uint32_t object, uint32_t *value);
bool takt_servo_write_object(struct servo *drive, uint32_t object, uint32_t value);

#endif
