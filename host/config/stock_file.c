#include "config/stock_file.h"

#include "cli/message.h"
#include "cli/text.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct reader {
    const char *name;
    const char *line; /* where it begins */
    const char *at;
    unsigned number;
    struct stock *stock;
};

static bool refuse(const struct reader *r, const char *what)
{
    message_error(r->name, r->number, (unsigned)(r->at - r->line) + 1, "%s", what);
    return false;
}

static void skip_blanks(struct reader *r)
{
    while (*r->at == ' ' || *r->at == '\t' || *r->at == '\r')
        r->at++;
}

static bool at_end(struct reader *r)
{
    skip_blanks(r);
    return *r->at == '\0' || *r->at == '\n' || *r->at == '#';
}

static bool read_number(struct reader *r, double *value)
{
    char *end;

    if (at_end(r))
        return refuse(r, "a number is missing: a row has its Y and a top for each X");
    *value = strtod(r->at, &end);
    if (end == r->at || !isfinite(*value) ||
        (!isspace((unsigned char)*end) && *end != '\0' && *end != '#'))
        return refuse(r, "this is not a number");
    r->at = end;
    return true;
}

/* The next value of a row or column of coordinates. */
static bool read_rising(struct reader *r, double *values, size_t count)
{
    const char *start;

    skip_blanks(r);
    start = r->at;
    if (!read_number(r, &values[count]))
        return false;
    if (count == 0 || values[count] > values[count - 1])
        return true;
    r->at = start;
    return refuse(r, "coordinates must rise");
}

static bool read_columns(struct reader *r)
{
    while (!at_end(r)) {
        if (!read_rising(r, r->stock->x_mm, r->stock->columns))
            return false;
        r->stock->columns++;
    }
    return r->stock->columns >= 2 || refuse(r, "two columns are the least");
}

static bool read_row(struct reader *r)
{
    struct stock *s = r->stock;

    if (!read_rising(r, s->y_mm, s->rows))
        return false;
    for (size_t i = 0; i < s->columns; i++) {
        if (!read_number(r, &s->top_mm[s->rows * s->columns + i]))
            return false;
    }
    s->rows++;
    return at_end(r) || refuse(r, "a row has its Y and a top for each X, and no more");
}

static bool read_line(struct reader *r)
{
    if (at_end(r))
        return true;
    return r->stock->columns == 0 ? read_columns(r) : read_row(r);
}

static bool read_lines(struct reader *r)
{
    const char *next;

    for (; r->line != NULL; r->line = next, r->number++) {
        r->at = r->line;
        next = strchr(r->line, '\n');
        next = next != NULL ? next + 1 : NULL;
        if (!read_line(r))
            return false;
    }
    if (r->stock->rows >= 2)
        return true;
    message_error(r->name, r->number - 1, 1, "a line of X and two rows are the least");
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
    struct text text;
    bool good;

    *stock = (struct stock){0};
    if (path == NULL)
        return true;
    if (!text_read(&text, path))
        return false;
    struct reader reader = {.name = text.name, .line = text.bytes, .number = 1, .stock = stock};

    good = make_room(stock, text.length) && strlen(text.bytes) == text.length;
    if (!good)
        message_command_error("%s: out of memory, or not a text", text.name);
    good = good && read_lines(&reader);
    text_free(&text);
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
