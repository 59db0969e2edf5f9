/*
 * Electronic data sheets of virtual drives, from files.
 */
#ifndef TAKT_HOST_DATA_SHEET_H
#define TAKT_HOST_DATA_SHEET_H

#include "cli/status.h"
#include "config/machine_setup.h"
#include "drives/virtual_drives.h"

/* False after a message. */
bool data_sheet_load(struct dictionary *dictionary, const char *path);

/*
 * Into a folder: a file for every drive. As a file: of the first drive; another maker's is not
 * written over.
 */
enum command_status data_sheet_write(const struct virtual_drives_config *drives, const char *path);

/*
 * All virtual drives of a machine: those of its axes on CAN, the second ones of gantries, I/O
 * nodes; sheet: memory for their dictionaries. False after a message.
 */
#define DATA_SHEETS_MAX MACHINE_SETUP_DRIVES_MAX
bool data_sheet_set_machine(struct virtual_drives_config *config, const struct machine_setup *setup,
                            struct dictionary sheet[DATA_SHEETS_MAX]);

/*
 * The drive at this index of the setup; sheet: memory for its dictionary, where it has one. False
 * after a message.
 */
bool data_sheet_set_drive(struct virtual_drive_config *drive, const struct machine_drive *config,
                          struct dictionary *sheet);

/*
 * The virtual I/O node of a machine: circuits that stop the axes are closed, every other input is
 * that of its output.
 */
void data_sheet_set_io(struct virtual_drive_config *drive, const struct io_wiring *wiring);

#endif
