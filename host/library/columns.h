/*
 * A trace in memory, column by column.
 */
#ifndef TAKT_LIBRARY_COLUMNS_H
#define TAKT_LIBRARY_COLUMNS_H

#include "results/trace_row.h"

#include <stdbool.h>
#include <stdint.h>

struct columns {
    unsigned axes; /* bit i set: those of axis i */
    double cycle_s;
    bool has_tool;
    unsigned count;
    struct trace_column column[TRACE_ROW_COLUMNS];
    double *value[TRACE_ROW_COLUMNS];
    uint64_t rows, room;
    bool failed; /* out of memory: rows are missing */
};

/* has_tool: every row has the tool's point, too. */
void columns_init(struct columns *c, unsigned axes, double cycle_s, bool has_tool);
/* tool: its point; not looked at where rows have none. */
void columns_add(struct columns *c, const struct cycle_record *record, const struct point *tool);
void columns_free(struct columns *c);

#endif
