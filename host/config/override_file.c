#include "config/override_file.h"

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
    double percent_max;
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

static bool at_end(const struct reader *r)
{
    return *r->at == '\0' || *r->at == '\n' || *r->at == '#';
}

static bool read_number(struct reader *r, const char *missing, double *value)
{
    char *end;

    skip_blanks(r);
    if (at_end(r))
        return refuse(r, missing);
    *value = strtod(r->at, &end);
    if (end == r->at || !isfinite(*value) ||
        (!isspace((unsigned char)*end) && *end != '\0' && *end != '#'))
        return refuse(r, "this is not a number");
    r->at = end;
    return true;
}

/* One row; an empty line and a comment have none. */
static bool read_row(struct reader *r, struct override_file *file)
{
    struct override_row row;

    skip_blanks(r);
    if (at_end(r))
        return true;
    if (!read_number(r, "a time in seconds is missing", &row.time_s))
        return false;
    if (row.time_s < 0 || (file->count > 0 && row.time_s < file->row[file->count - 1].time_s))
        return refuse(r, "the time must not be negative, nor before that of the line above");
    if (!read_number(r, "per cent are missing behind the time", &row.percent))
        return false;
    if (row.percent < 0 || row.percent > r->percent_max)
        return refuse(r, r->percent_max > 100 ? "the feed override is 0 ... 120 %"
                                              : "the rapid override is 0 ... 100 %");
    skip_blanks(r);
    if (!at_end(r))
        return refuse(r, "nothing may follow time and per cent");
    file->row[file->count++] = row;
    return true;
}

static size_t count_lines(const char *text)
{
    size_t count = 1;

    for (; *text != '\0'; text++)
        count += *text == '\n' ? 1 : 0;
    return count;
}

static bool read_rows(struct reader *r, struct override_file *file)
{
    const char *next;

    for (; r->line != NULL; r->line = next, r->number++) {
        r->at = r->line;
        next = strchr(r->line, '\n');
        next = next != NULL ? next + 1 : NULL;
        if (!read_row(r, file))
            return false;
    }
    return true;
}

bool override_file_load(struct override_file *file, const char *path, double percent_max)
{
    struct text text;
    bool good;

    *file = (struct override_file){.percent = 100};
    if (path == NULL)
        return true;
    if (!text_read(&text, path))
        return false;
    struct reader reader = {
        .name = text.name, .line = text.bytes, .number = 1, .percent_max = percent_max};

    file->row = calloc(count_lines(text.bytes), sizeof *file->row);
    good = file->row != NULL && strlen(text.bytes) == text.length;
    if (!good)
        message_command_error("%s: out of memory, or not a text", text.name);
    good = good && read_rows(&reader, file);
    text_free(&text);
    if (!good)
        override_file_free(file);
    return good;
}

void override_file_free(struct override_file *file)
{
    free(file->row);
    *file = (struct override_file){.percent = 100};
}

double override_file_at(struct override_file *file, double time_s)
{
    while (file->next < file->count && file->row[file->next].time_s <= time_s) {
        file->percent = file->row[file->next].percent;
        file->next++;
    }
    return file->percent;
}
