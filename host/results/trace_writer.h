/*
 * The trace of a run: CSV, one row per program cycle. Columns and precision: README.md.
 */
#ifndef TAKT_HOST_TRACE_WRITER_H
#define TAKT_HOST_TRACE_WRITER_H

#include "base/point.h"
#include "motion/cycle_record.h"
#include "results/trace_row.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#define TRACE_BUFFER_SIZE 262144

struct trace_writer {
    FILE *stream; /* the caller's */
    bool failed;
    unsigned axes; /* bit i set: column of axis i */
    struct trace_column column[TRACE_ROW_COLUMNS];
    double cycle_s;
    bool has_tool;
    size_t used;
    char buffer[TRACE_BUFFER_SIZE];
};

/* Writes the header row. axes: bit i set for axis i. has_tool: every row has the tool's point. */
void trace_writer_init(struct trace_writer *w, FILE *stream, unsigned axes, double cycle_s,
                       bool has_tool);
/* tool: its point; not looked at where rows have none. */
void trace_writer_add(struct trace_writer *w, const struct cycle_record *record,
                      const struct point *tool);
/* Hands the rest to the stream. False: this or an earlier write has failed. */
bool trace_writer_flush(struct trace_writer *w);

#endif
