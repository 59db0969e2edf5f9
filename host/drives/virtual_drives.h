/*
 * The virtual drives of a machine, as nodes of one embedded bus.
 *
 * Every control cycle: the controller sends, bus_run_until lets the frames of the cycle travel, and
 * virtual_drives_step moves the motors by one cycle.
 */
#ifndef TAKT_DRIVES_VIRTUAL_DRIVES_H
#define TAKT_DRIVES_VIRTUAL_DRIVES_H

#include "bus/bus.h"
#include "drives/virtual_drive.h"

#define VIRTUAL_DRIVES_MAX 6

struct virtual_drives_config {
    unsigned count; /* 1 ... VIRTUAL_DRIVES_MAX */
    struct virtual_drive_config
        drive[VIRTUAL_DRIVES_MAX]; /* in the machine's order: it makes the pairs */
};

struct virtual_drives {
    unsigned count;
    struct virtual_drive drive[VIRTUAL_DRIVES_MAX];
};

/* The default plant for every drive, nodes 1, 2, ..., 100,000 increments/mm, standing at 0. */
void virtual_drives_set_default(struct virtual_drives_config *config, unsigned count);

/*
 * Attaches the drives to the bus and boots them. set and bus must stay where they are from now on.
 */
void virtual_drives_init(struct virtual_drives *set, struct bus *bus,
                         const struct virtual_drives_config *config);

void virtual_drives_step(struct virtual_drives *set, uint32_t cycle_ns);

#endif
