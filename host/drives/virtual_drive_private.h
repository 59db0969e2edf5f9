/*
 * Shared by the sources of a virtual drive.
 */
#ifndef TAKT_DRIVES_VIRTUAL_DRIVE_PRIVATE_H
#define TAKT_DRIVES_VIRTUAL_DRIVE_PRIVATE_H

#include "drives/virtual_drive.h"

/* Begins and ends the scripted faults whose time has come. */
void virtual_drive_run_faults(struct virtual_drive *drive);
/* What faults in force make of the drive. */
struct servo_meddler virtual_drive_meddler(struct virtual_drive *drive);

#endif
