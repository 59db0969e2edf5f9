#include "tables/stock_file.h"

#include "cli/message.h"
#include "tables/rows.h"

#include <stdlib.h>

static bool read_number(struct rows *rows, double *value)
{
    return rows_read_number(rows, "a number is missing: a row has its Y and a top for each X",
                            value);
}

/* The next value of a row or column of coordinates. */
static bool read_rising(struct rows *rows, double *values, size_t count)
{
    const char *start;

    (void)rows_is_at_end(rows);
    start = rows->at;
    if (!read_number(rows, &values[count]))
        return false;
    if (count == 0 || values[count] > values[count - 1])
        return true;
    rows->at = start;
    return rows_refuse(rows, "coordinates must rise");
}

static bool read_columns(struct rows *rows, struct stock *s)
{
    while (!rows_is_at_end(rows)) {
        if (!read_rising(rows, s->x_mm, s->columns))
            return false;
        s->columns++;
    }
    return s->columns >= 2 || rows_refuse(rows, "two columns are the least");
}

static bool read_row(struct rows *rows, struct stock *s)
{
    if (!read_rising(rows, s->y_mm, s->rows))
        return false;
    for (size_t i = 0; i < s->columns; i++) {
        if (!read_number(rows, &s->top_mm[s->rows * s->columns + i]))
            return false;
    }
    s->rows++;
    return rows_is_at_end(rows) ||
           rows_refuse(rows, "a row has its Y and a top for each X, and no more");
}

static bool read_rows(struct rows *rows, struct stock *s)
{
    while (rows_next(rows)) {
        if (!(s->columns == 0 ? read_columns(rows, s) : read_row(rows, s)))
            return false;
    }
    if (s->rows >= 2)
        return true;
    message_error(rows->text.name, rows->number, 1, "a line of X and two rows are the least");
    return false;
}

/* A text has no more numbers than half of its characters, rounded up. */
static bool make_room(struct stock *stock, size_t length)
{
    const size_t most = length / 2 + 1;

    stock->x_mm = calloc(most, sizeof *stock->x_mm);
    stock->y_mm = calloc(most, sizeof *stock->y_mm);
    stock->top_mm = calloc(most, sizeof *stock->top_mm);
    return stock->x_mm != NULL && stock->y_mm != NULL && stock->top_mm != NULL;
}

bool stock_file_load(struct stock *stock, const char *path)
{
    struct rows rows;
    bool good;

    *stock = (struct stock){0};
    if (path == NULL)
        return true;
    if (!rows_open(&rows, path))
        return false;
    good = make_room(stock, rows.text.length);
    if (!good)
        message_command_error("%s: out of memory", path);
    good = good && read_rows(&rows, stock);
    rows_close(&rows);
    if (!good)
        stock_file_free(stock);
    return good;
}

void stock_file_free(struct stock *stock)
{
    free(stock->x_mm);
    free(stock->y_mm);
    free(stock->top_mm);
    *stock = (struct stock){0};
}
