/*
 * Electronic data sheets of virtual drives, from files.
 */
#ifndef TAKT_HOST_DATA_SHEET_H
#define TAKT_HOST_DATA_SHEET_H

#include "drives/virtual_drives.h"
#include "takt/machine_setup.h"

/* False after a message. */
bool data_sheet_load(struct dictionary *dictionary, const char *path);

/* The drive of an axis; sheet: memory for its dictionary, where it has one. False after a message. */
bool data_sheet_set_drive(struct virtual_drive_config *drive, const struct machine_drive *config,
                          struct dictionary *sheet);

/* The virtual I/O node of a machine: circuits that stop the axes are closed, every other input is that of its output. */
void data_sheet_set_io(struct virtual_drive_config *drive, const struct io_wiring *wiring);

#endif
