/*
 * Reading a trace row by row.
 */
#ifndef TAKT_HOST_TRACE_READER_H
#define TAKT_HOST_TRACE_READER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#define TRACE_COLUMNS_MAX 64

struct trace_reader {
    const char *name; /* for messages */
    FILE *stream;
    uint32_t line; /* of the row read last; the header is line 1 */
    unsigned columns;
    char *header;                          /* owned; the columns' names are in it */
    const char *column[TRACE_COLUMNS_MAX]; /* names */
    char *text;                            /* owned: the current line */
    size_t room;
    double value[TRACE_COLUMNS_MAX]; /* of the row read last */
};

enum trace_row { TRACE_ROW, TRACE_END, TRACE_BAD };

/* path "-": standard input. False after a message. trace_reader_close is due in either case. */
bool trace_reader_open(struct trace_reader *r, const char *path);
void trace_reader_close(struct trace_reader *r);

/* TRACE_BAD after a message. */
enum trace_row trace_reader_next(struct trace_reader *r);

/* Index of a column, or -1. */
int trace_reader_find(const struct trace_reader *r, const char *name);

#endif
