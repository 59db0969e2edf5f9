/*
 * Shared by the sources of a virtual drive.
 */
#ifndef TAKT_DRIVES_VIRTUAL_DRIVE_PRIVATE_H
#define TAKT_DRIVES_VIRTUAL_DRIVE_PRIVATE_H

#include "drives/virtual_drive.h"

/* Around whatever changes the drive from outside: its twin is told the same. */
void virtual_drive_begin(const struct virtual_drive *drive, const struct twin_order *order);
void virtual_drive_end(const struct virtual_drive *drive);

/* Begins and ends the scripted faults whose time has come. */
void virtual_drive_run_faults(struct virtual_drive *drive);
/* What faults in force make of the drive. */
struct servo_meddler virtual_drive_meddler(struct virtual_drive *drive);

#endif
