/*
 * The columns of a trace, in the order and units of README.md: for who writes them as CSV and who
 * keeps them in memory.
 */
#ifndef TAKT_HOST_TRACE_ROW_H
#define TAKT_HOST_TRACE_ROW_H

#include "base/point.h"
#include "motion/cycle_record.h"

#include <stdbool.h>

/*
 * Cycle, time, block, line, feed, override, limiter, three of every axis, the spindle's angle, the
 * tool's point.
 */
#define TRACE_ROW_COLUMNS     (8 + 3 * AXIS_COUNT + AXIS_LINEAR_COUNT)
#define TRACE_COLUMN_NAME_MAX 23

struct trace_column {
    char name[TRACE_COLUMN_NAME_MAX + 1];
    unsigned places; /* behind the point, in CSV */
};

/*
 * Returns how many there are. axes: bit i set: those of axis i. has_tool: the tool's point is known
 * beside the drives.
 */
unsigned trace_columns(unsigned axes, bool has_tool, struct trace_column column[TRACE_ROW_COLUMNS]);
/* The values of a cycle, likewise. tool: its point; NULL: it is not known. */
unsigned trace_values(unsigned axes, double cycle_s, const struct cycle_record *record,
                      const struct point *tool, double value[TRACE_ROW_COLUMNS]);

#endif
