/*
 * The first line of a table: its columns. Private to this room.
 */
#ifndef TAKT_CORRECTION_TABLE_HEADER_H
#define TAKT_CORRECTION_TABLE_HEADER_H

#include "correction/table.h"
#include "correction/table_cells.h"

#define TABLE_COLUMNS_MAX (TABLE_INPUTS_MAX + TABLE_OUTPUTS_MAX)

struct table_header {
    unsigned columns;
    double unit[TABLE_COLUMNS_MAX]; /* mm or rad per unit of the column */
};

/* Reads the current line into inputs, outputs and units. False: *wrong is set. */
bool takt_table_header_read(struct cells *cells, struct table *table, struct table_header *header,
                            struct diagnostic *wrong);

#endif
