/*
 * The CiA 402 drives of a machine as seen from the controller: setpoints in, positions and states out,
 * CANopen frames through a CAN port.
 *
 * Once a cycle, in this order:
 *     drives_receive   everything that has come since the last cycle
 *     drives_sync      SYNC: the drives latch the targets sent last cycle and sample their positions
 *     drives_send      controlwords that changed, and the targets of this cycle
 */
#ifndef TAKT_DRIVE_DRIVES_H
#define TAKT_DRIVE_DRIVES_H

#include "base/error.h"
#include "base/point.h"
#include "hal/can.h"

#include <stdbool.h>
#include <stdint.h>

/*
 * Cycles from a setpoint's being sent to the report of the position the drive had when it should have reached it.
 * Sent in cycle k, latched at SYNC k + 1, interpolated to until SYNC k + 2, where the position is sampled; that
 * report is received by drives_receive in cycle k + 3.
 */
#define DRIVES_LATENCY_CYCLES 3

struct drives_config {
    unsigned count; /* drives, 1 ... AXIS_COUNT */
    struct drives_config_axis {
        enum axis axis;
        uint8_t node;                  /* CANopen node id, 1 ... 127 */
        double increments_per_mm;      /* drive position units per mm or rad */
        double following_error_max_mm; /* alarm beyond; 0: not watched */
    } axis[AXIS_COUNT];
    uint32_t start_timeout_cycles;  /* all drives must be enabled within; else DRIVE_SILENT */
    uint32_t answer_timeout_cycles; /* a drive silent for longer is lost: DRIVE_SILENT */
};

enum drives_state { DRIVES_STARTING, DRIVES_ENABLED, DRIVES_FAULTED };

#include "drive/drives_state.h"

void drives_init(struct drives *d, const struct drives_config *config);
void drives_receive(struct drives *d, const struct can_port *port);
void drives_sync(struct drives *d, const struct can_port *port);
/* setpoint: of every axis, mm or rad. Ignored until the drives are enabled (they are held where they stand). */
void drives_send(struct drives *d, const struct can_port *port, const struct point *setpoint);

enum drives_state drives_get_state(const struct drives *d);
/* Last reported actual position of every axis, mm or rad; 0 for axes without a drive. */
void drives_get_actual(const struct drives *d, struct point *actual);
/*
 * Data lengths, in bytes, of the frames a cycle puts on the bus at most while nothing is wrong: SYNC, the targets, a
 * status per drive, and one of the status frames that drives send now and then. Returns their number. By them can be
 * told before the start whether the bus carries the cycle. count: drives, 1 ... AXIS_COUNT.
 */
#define DRIVES_CYCLE_FRAMES_MAX (2 + AXIS_COUNT + (AXIS_COUNT + 1) / 2)
unsigned drives_cycle_frames(unsigned count, uint8_t length[DRIVES_CYCLE_FRAMES_MAX]);

/* What went wrong; meaningful in DRIVES_FAULTED. */
const struct diagnostic *drives_get_fault(const struct drives *d);

#endif
