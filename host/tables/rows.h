/*
 * Text files with numbers in rows: blanks between them, lines without any, comments from # on.
 * Errors are told with file, line and column.
 */
#ifndef TAKT_HOST_ROWS_H
#define TAKT_HOST_ROWS_H

#include "cli/text.h"

#include <stdbool.h>
#include <stddef.h>

/* Private, but for text.length. */
struct rows {
    struct text text;
    const char *line; /* where the present one begins; NULL: before the first */
    const char *at;
    unsigned number;
};

/* False after a message: there is no such file, or it is no text. Else rows_close is due. */
bool rows_open(struct rows *rows, const char *path);
void rows_close(struct rows *rows);

/* Number of lines, at most. */
size_t rows_count_lines(const struct rows *rows);

/* Goes to the next row. False: there is none. */
bool rows_next(struct rows *rows);

/* No number is left in the row; goes to the next one, if there is one. */
bool rows_is_at_end(struct rows *rows);

/* The next number of the row. False after a message, `missing` where the row has ended. */
bool rows_read_number(struct rows *rows, const char *missing, double *value);

/* False after this message, at the place in the row. */
bool rows_refuse(const struct rows *rows, const char *what);

#endif
