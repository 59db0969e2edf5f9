/*
 * A virtual drive: a CANopen node (CiA 301) with the drive profile CiA 402-2, and the motor behind
 * it. It knows a port, not a bus: whoever owns it hands in the frames and the time.
 *
 * Modes of operation: profile position, velocity and torque, homing, interpolated position, cyclic synchronous position,
 * velocity and torque.
 */
#ifndef TAKT_DRIVES_VIRTUAL_DRIVE_H
#define TAKT_DRIVES_VIRTUAL_DRIVE_H

#include "canopen/cia402.h"
#include "canopen/emcy.h"
#include "canopen/nmt.h"
#include "canopen/pdo.h"
#include "canopen/time_stamp.h"
#include "drives/dictionary.h"
#include "drives/drive_event.h"
#include "drives/drive_objects.h"
#include "drives/drive_plant.h"
#include "drives/object_table.h"
#include "drives/sdo_server.h"
#include "hal/can.h"
#include "inject/inject.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct virtual_drive_config {
    uint8_t node; /* 1 ... 127 */
    double
        increments_per_mm; /* position units of the drive per mm or rad; < 0: its motor turns the other way */
    double velocity_units_per_mm_s; /* its units of velocity; 0: position units in a second */
    uint32_t cycle_us; /* between two targets at power-on (object 60C2); 0: a millisecond */
    uint32_t boot_us;  /* from a reset to the boot-up message */
    uint32_t sdo_us;   /* from a request to its answer */
    bool is_fd;        /* its bus is CAN FD: PDOs of up to 64 bytes */
    bool
        is_nameless; /* it has no node id before it gets one by LSS; node is then its serial number alone */
    const struct dictionary *dictionary; /* must stay; NULL: takt's own */
    struct drive_plant_config plant;
    bool
        is_io; /* no drive but an I/O node (CiA 401), of dictionary_io: nothing of the motor counts */
    uint16_t closed; /* its inputs that are high for good; the others are those of its outputs */
};

struct virtual_drive;

#include "drives/virtual_drive_state.h"

/*
 * Switches the drive on; it has not booted yet. config is copied and has been checked
 * (drive_plant_check). target: its RPDO2, see canopen/target_pdo.h; NULL: what the dictionary says.
 * port must stay usable as long as the drive.
 */
void virtual_drive_init(struct virtual_drive *drive, const struct virtual_drive_config *config,
                        const struct pdo *target, const struct can_port *port);

/* Both may be left out. eds: the text of object 1021; it must stay. */
void virtual_drive_observe(struct virtual_drive *drive, const struct drive_observer *observer);
void virtual_drive_set_eds(struct virtual_drive *drive, const char *eds, size_t length);

/*
 * Who is to keep what object 1010 stores, and 1011 takes back, beyond the drive's own life; drive_store.h has a form for
 * that. Without one it lives as long as the drive.
 */
void virtual_drive_keep(struct virtual_drive *drive, const struct drive_keeper *keeper);

/*
 * Faults of the script that name this drive happen by the clock, which the caller keeps running.
 * Both must stay where they are. NULL: none.
 */
void virtual_drive_inject(struct virtual_drive *drive, const struct inject *script,
                          const struct inject_clock *clock);

/* Sends the boot-up message and enters the state pre-operational. */
void virtual_drive_boot(struct virtual_drive *drive);

/* A frame has come; the drive may send answers. */
void virtual_drive_on_frame(struct virtual_drive *drive, const struct can_frame *frame);
/* The same where the time on the bus is known: targets behind the window of object 1007 are none. */
void virtual_drive_on_frame_at(struct virtual_drive *drive, const struct can_frame *frame,
                               uint64_t time_ns);

/*
 * Time goes on by one cycle (> 0), which follows the SYNC just received: motor, supervision,
 * timers.
 */
void virtual_drive_step(struct virtual_drive *drive, uint32_t cycle_ns);

/*
 * After a step: within it, when so much of it had passed, 0 ... 1, the input of the touch probes became so. A level that it
 * has already is no edge.
 */
void virtual_drive_touch(struct virtual_drive *drive, bool touches, double ratio);
/* The position that the drive had then by its encoder, unrounded. */
double virtual_drive_get_position_at_mm(const struct virtual_drive *drive, double ratio);

enum cia402_state virtual_drive_get_state(const struct virtual_drive *drive);
enum nmt_state virtual_drive_get_nmt_state(const struct virtual_drive *drive);
/* True position of the axis, unrounded. */
double virtual_drive_get_position_mm(const struct virtual_drive *drive);
/* What the controller says of the time between two SYNCs, object 1006, else 60C2; 0: nothing. */
uint32_t virtual_drive_get_sync_period_us(const struct virtual_drive *drive);

/* The shortest time without a heartbeat (1016) or a guarding frame (100C) that it takes, ms; 0: it watches none. */
uint32_t virtual_drive_get_watched_ms(const struct virtual_drive *drive);

/* The frame is SYNC to this drive (object 1005). */
bool virtual_drive_is_sync(const struct virtual_drive *drive, const struct can_frame *frame);

/*
 * Objects of the drive by their mapping entry (canopen/cia402.h), as raw bits. False: no such
 * object of that length; for write also one that cannot be written, or not to this value.
 */
bool virtual_drive_read_object(struct virtual_drive *drive, uint32_t object, uint32_t *value);
bool virtual_drive_write_object(struct virtual_drive *drive, uint32_t object, uint32_t value);

#endif
