/*
 * Lines and cells of a table's text. Private to this room.
 */
#ifndef TAKT_CORRECTION_TABLE_CELLS_H
#define TAKT_CORRECTION_TABLE_CELLS_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct cells {
    const char *text;
    size_t length;
    size_t next;        /* where the line after this one begins */
    size_t begin, end;  /* of the current line */
    size_t cell, until; /* of the current cell, without spaces around it */
    size_t position;    /* behind the current cell's separator */
    bool more;          /* there is another cell */
    uint32_t line;
};

void takt_cells_open(struct cells *c, const char *text, size_t length);

/* Goes to the next line that is neither empty nor a comment. False: there is none. */
bool takt_cells_next_line(struct cells *c);

/*
 * Goes to the next cell of the line. False: there is none. white: spaces separate cells, not
 * commas.
 */
bool takt_cells_next(struct cells *c, bool white);

/* Does the current cell read so? */
bool takt_cells_is(const struct cells *c, const char *word);

/* The current cell as a number. TAKT_OK, TAKT_ERROR_TABLE_NUMBER or TAKT_ERROR_TABLE_NOT_FINITE. */
enum takt_error takt_cells_number(const struct cells *c, double *value);

/* An error about the current cell. Always false. */
bool takt_cells_refuse(const struct cells *c, struct diagnostic *wrong, enum takt_error code,
                       double value);

#endif
