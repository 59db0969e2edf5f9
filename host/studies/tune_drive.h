/*
 * One virtual drive of a machine by itself, told what to do cycle by cycle through its objects.
 */
#ifndef TAKT_HOST_TUNE_DRIVE_H
#define TAKT_HOST_TUNE_DRIVE_H

#include "drives/virtual_drive.h"
#include "tuning/gains.h"

#include <stdbool.h>
#include <stdint.h>

struct tune_drive {
    struct virtual_drive_config config;
    uint32_t cycle_ns;
    struct virtual_drive drive;
};

/*
 * Switches it on where it stands, and enables it in a mode (6060). False: it does not come. drive
 * must stay where it is.
 */
bool tune_drive_start(struct tune_drive *drive, int8_t mode);

/*
 * Objects by index, sub-index and length in bits. False: there is no such object, or it does not
 * take the value.
 */
bool tune_drive_read(struct tune_drive *drive, uint16_t index, uint8_t sub, unsigned bits,
                     uint32_t *value);
bool tune_drive_write(struct tune_drive *drive, uint16_t index, uint8_t sub, unsigned bits,
                      uint32_t value);

/* Object 2020. */
bool tune_drive_get_gains(struct tune_drive *drive, struct tuning_gains *gains);
bool tune_drive_set_gains(struct tune_drive *drive, const struct tuning_gains *gains);

/*
 * What it is told for the next cycle: torque in thousandths of the rated one, where the axis is to
 * be in mm or rad.
 */
void tune_drive_push(struct tune_drive *drive, int32_t torque);
void tune_drive_aim(struct tune_drive *drive, double position);
void tune_drive_cycle(struct tune_drive *drive);

/* Where it says that the axis is (6064), mm or rad; and how far the last target was from there. */
double tune_drive_position(struct tune_drive *drive);
bool tune_drive_is_enabled(const struct tune_drive *drive);

#endif
