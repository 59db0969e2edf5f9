#define _POSIX_C_SOURCE 200809L

#include "trace/trace_reader.h"

#include "cli/files_read.h"
#include "cli/message.h"
#include "cli/utf8.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* The next line without its end. False: there is none. */
static bool read_line(struct trace_reader *r)
{
    ssize_t length = getline(&r->text, &r->room, r->stream);

    if (length < 0)
        return false;
    while (length > 0 && (r->text[length - 1] == '\n' || r->text[length - 1] == '\r'))
        r->text[--length] = '\0';
    r->line++;
    return true;
}

static bool read_header(struct trace_reader *r)
{
    char *rest = NULL;

    if (!read_line(r)) {
        message_error(r->name, 0, 0, "the trace is empty");
        return false;
    }
    r->header = strdup(strncmp(r->text, UTF8_MARK, sizeof UTF8_MARK - 1) == 0
                           ? r->text + sizeof UTF8_MARK - 1
                           : r->text);
    if (r->header == NULL) {
        message_command_error("out of memory");
        return false;
    }
    for (char *name = strtok_r(r->header, ",", &rest); name != NULL;
         name = strtok_r(NULL, ",", &rest)) {
        if (r->columns == TRACE_COLUMNS_MAX) {
            message_error(r->name, 1, 0, "more than %d columns", TRACE_COLUMNS_MAX);
            return false;
        }
        r->column[r->columns++] = name;
    }
    if (trace_reader_find(r, "cycle") >= 0 && trace_reader_find(r, "time_s") >= 0)
        return true;
    message_error(r->name, 1, 1, "this is no trace: columns 'cycle' and 'time_s' are missing");
    return false;
}

bool trace_reader_open(struct trace_reader *r, const char *path)
{
    bool standard = strcmp(path, "-") == 0;

    *r = (struct trace_reader){.name = standard ? "<stdin>" : path};
    r->stream = standard ? stdin : fopen(path, "rb");
    files_read_note(path);
    if (r->stream != NULL)
        return read_header(r);
    message_error(r->name, 0, 0, "cannot be opened: %s", strerror(errno));
    return false;
}

void trace_reader_close(struct trace_reader *r)
{
    if (r->stream != NULL && r->stream != stdin)
        (void)fclose(r->stream);
    free(r->header);
    free(r->text);
    *r = (struct trace_reader){0};
}

enum trace_row trace_reader_next(struct trace_reader *r)
{
    char *at = NULL;

    if (!read_line(r))
        return TRACE_END;
    at = r->text;
    for (unsigned i = 0; i < r->columns; i++) {
        char *end;
        char expected = i + 1 < r->columns ? ',' : '\0';

        r->value[i] = strtod(at, &end);
        if (end == at || *end != expected) {
            message_error(r->name, r->line, (uint32_t)(at - r->text) + 1,
                          "column %s: a number is expected", r->column[i]);
            return TRACE_BAD;
        }
        at = end + 1;
    }
    return TRACE_ROW;
}

int trace_reader_find(const struct trace_reader *r, const char *name)
{
    for (unsigned i = 0; i < r->columns; i++) {
        if (strcmp(r->column[i], name) == 0)
            return (int)i;
    }
    return -1;
}
