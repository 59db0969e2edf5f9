/*
 * Shared by the sources of this room.
 */
#ifndef TAKT_DRIVE_DRIVES_PRIVATE_H
#define TAKT_DRIVE_DRIVES_PRIVATE_H

#include "drive/drives.h"

/* TPDO1: statusword and actual position. TPDO2, which is not evaluated, is of the same length. */
#define DRIVES_STATUS_LENGTH 6

/*
 * Enters DRIVES_FAULTED for the drive at this index. The first fault stays: what follows is its
 * consequence.
 */
void drives_raise(struct drives *d, unsigned index, enum takt_error error, double value);

double drives_axis_actual_mm(const struct drives_axis *axis);

bool drives_axis_is_enabled(const struct drives_axis *axis);

#endif
