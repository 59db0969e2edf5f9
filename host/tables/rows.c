#include "tables/rows.h"

#include "cli/message.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

bool rows_open(struct rows *rows, const char *path)
{
    *rows = (struct rows){0};
    if (!text_read(&rows->text, path))
        return false;
    if (strlen(rows->text.bytes) == rows->text.length)
        return true;
    message_command_error("%s: not a text", rows->text.name);
    rows_close(rows);
    return false;
}

void rows_close(struct rows *rows)
{
    text_free(&rows->text);
}

size_t rows_count_lines(const struct rows *rows)
{
    size_t count = 1;

    for (const char *c = rows->text.bytes; *c != '\0'; c++)
        count += *c == '\n' ? 1 : 0;
    return count;
}

static const char *next_line(const struct rows *rows)
{
    const char *end;

    if (rows->line == NULL)
        return rows->text.bytes;
    end = strchr(rows->line, '\n');
    return end != NULL ? end + 1 : NULL;
}

bool rows_next(struct rows *rows)
{
    const char *line;

    while ((line = next_line(rows)) != NULL) {
        rows->line = rows->at = line;
        rows->number++;
        if (!rows_is_at_end(rows))
            return true;
    }
    return false;
}

bool rows_is_at_end(struct rows *rows)
{
    while (*rows->at == ' ' || *rows->at == '\t' || *rows->at == '\r')
        rows->at++;
    return *rows->at == '\0' || *rows->at == '\n' || *rows->at == '#';
}

bool rows_read_number(struct rows *rows, const char *missing, double *value)
{
    char *end;

    if (rows_is_at_end(rows))
        return rows_refuse(rows, missing);
    *value = strtod(rows->at, &end);
    if (end == rows->at || !isfinite(*value) ||
        (!isspace((unsigned char)*end) && *end != '\0' && *end != '#'))
        return rows_refuse(rows, "this is not a number");
    rows->at = end;
    return true;
}

bool rows_refuse(const struct rows *rows, const char *what)
{
    message_error(rows->text.name, rows->number, (unsigned)(rows->at - rows->line) + 1, "%s", what);
    return false;
}
