/*
 * Correction tables as text (CSV). The first line that is no comment names the columns with their
 * units:
 *
 *     X_mm,Y_mm,Z_mm,KX_um,KY_um,KZ_um        a volume: the grid's axes, then the corrections
 *     X_mm,KX_up_um,KX_down_um,KY_um          one axis, both directions of approach where they differ
 *     X_mm,EX_um,EY_um,EZ_um,EA_urad,EB_urad  errors of a unit (geometry.h): its shifts, and its turns about X, Y and Z
 *
 * Units: mm, um, in for linear axes, deg, rad, urad, arcsec for rotary ones. Columns are separated
 * by commas, semicolons or tabs. Lines that begin with # are comments. A last line
 * "checksum,1a2b3c4d" is the CRC-32 of every byte before it: takt writes it, and checks it where it
 * stands.
 */
#ifndef TAKT_CORRECTION_TABLE_TEXT_H
#define TAKT_CORRECTION_TABLE_TEXT_H

#include "correction/table.h"

/*
 * Reads and checks a table. False: *wrong names line, column and cell, and *table holds nothing of
 * use. The text need not end in zero.
 */
bool takt_table_read_text(const char *text, size_t length, const struct table_rules *rules,
                          struct table *table, struct diagnostic *wrong);

/*
 * Reads an axis table in the form of LinuxCNC's COMP_FILE: lines of "nominal forward reverse", for
 * the correction of axis itself. type: 0: the actual positions when moving up and down
 * (nominal - actual is corrected); 1: corrections to be added to the motor's position. unit_mm: mm
 * (or rad) per unit of the file. Comments and checks as above.
 */
bool takt_table_read_triplets(const char *text, size_t length, enum axis axis, unsigned type,
                              double unit_mm, const struct table_rules *rules, struct table *table,
                              struct diagnostic *wrong);

/* Where written text goes. */
struct table_sink {
    void *context;
    void (*write)(void *context, const char *text, size_t length);
};

/*
 * Writes a table that reads as this one, to 1e-6 um (urad), with its checksum. comment: one line,
 * or NULL.
 */
void takt_table_write_text(const struct table *table, const char *comment,
                           const struct table_sink *sink);

#endif
