/*
 * Correction tables of a machine: CSV files, read, checked and made ready for the control cycle.
 */
#ifndef TAKT_HOST_CORRECTION_FILE_H
#define TAKT_HOST_CORRECTION_FILE_H

#include "config/machine_setup.h"
#include "correction/table.h"
#include "correction/tables.h"

#include <stdbool.h>

/*
 * Reads the tables that the machine file names into *tables: allocated, NULL when it names none,
 * freed with free(). Also refuses a machine whose correction would take more than
 * CORRECTION_SHARE_MAX of an axis. False after a message.
 */
bool correction_file_load(struct correction_tables **tables, const struct machine_setup *setup);

/* Reads and checks one file. False after a message that names file, line and cell. */
bool correction_file_read(struct table *table, const char *path, const struct machine *machine);

/* The same for LinuxCNC's COMP_FILE of an axis; type as COMP_FILE_TYPE has it. */
bool correction_file_read_triplets(struct table *table, const char *path, enum axis axis,
                                   unsigned type, const struct machine *machine);

/*
 * Writes a table as CSV, with a comment of one line. False after a message; nothing is left then.
 */
bool correction_file_write(const struct table *table, const char *path, const char *comment);

#endif
