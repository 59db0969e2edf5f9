/*
 * A virtual drive: a CANopen node (CiA 301) with the drive profile CiA 402-2 in cyclic synchronous
 * position mode, and the motor behind it. It knows a port, not a bus: whoever owns it hands in the
 * frames and the time.
 */
#ifndef TAKT_DRIVES_VIRTUAL_DRIVE_H
#define TAKT_DRIVES_VIRTUAL_DRIVE_H

#include "canopen/cia402.h"
#include "canopen/nmt.h"
#include "canopen/pdo.h"
#include "drives/drive_plant.h"
#include "hal/can.h"

#include <stdbool.h>
#include <stdint.h>

#define VIRTUAL_DRIVE_PDO_COUNT 2 /* RPDOs and as many TPDOs */

/* Period of the event-driven TPDOs, object 1800 ff., sub-index 5. */
#define VIRTUAL_DRIVE_EVENT_MS 100

struct virtual_drive_config {
    uint8_t node;             /* 1 ... 127 */
    double increments_per_mm; /* position units of the drive per mm or rad; > 0 */
    double start_mm;          /* where the axis stands at power-on; an absolute encoder keeps it */
    struct drive_plant_config plant;
};

/* Private: read it through the functions below. */
struct virtual_drive {
    struct virtual_drive_config config;
    struct can_port port;
    struct drive_plant plant;

    enum nmt_state nmt;
    enum cia402_state state;
    uint16_t controlword;   /* object 6040 */
    int8_t mode;            /* 6060 and 6061 */
    int32_t target_inc;     /* 607A */
    uint16_t error_code;    /* 603F */
    uint8_t error_register; /* 1001 */

    struct pdo rpdo[VIRTUAL_DRIVE_PDO_COUNT];
    struct pdo tpdo[VIRTUAL_DRIVE_PDO_COUNT];
    struct can_frame held[VIRTUAL_DRIVE_PDO_COUNT]; /* synchronous RPDOs that wait for SYNC */
    bool is_held[VIRTUAL_DRIVE_PDO_COUNT];
    uint64_t event_ns; /* since the last event-driven TPDOs */
};

/*
 * Switches the drive on; it has not booted yet. config is copied and has been checked
 * (drive_plant_check). target: its RPDO2, see canopen/target_pdo.h. port must stay usable as long
 * as the drive.
 */
void virtual_drive_init(struct virtual_drive *drive, const struct virtual_drive_config *config,
                        const struct pdo *target, const struct can_port *port);

/* Sends the boot-up message and enters the state pre-operational. */
void virtual_drive_boot(struct virtual_drive *drive);

/* A frame has come; the drive may send answers. */
void virtual_drive_on_frame(struct virtual_drive *drive, const struct can_frame *frame);

/*
 * Time goes on by one cycle (> 0), which follows the SYNC just received: motor, supervision, event
 * timers.
 */
void virtual_drive_step(struct virtual_drive *drive, uint32_t cycle_ns);

enum cia402_state virtual_drive_get_state(const struct virtual_drive *drive);
enum nmt_state virtual_drive_get_nmt_state(const struct virtual_drive *drive);
/* True position of the axis, unrounded. */
double virtual_drive_get_position_mm(const struct virtual_drive *drive);

/*
 * Objects of the drive by their mapping entry (canopen/cia402.h), as raw bits. False: no such
 * object; for write also one that cannot be written.
 */
bool virtual_drive_read_object(const struct virtual_drive *drive, uint32_t object, uint32_t *value);
bool virtual_drive_write_object(struct virtual_drive *drive, uint32_t object, uint32_t value);

#endif
