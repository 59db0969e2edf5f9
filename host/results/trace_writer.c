#include "results/trace_writer.h"

#include "base/decimal.h"

/* Numbers of a row, and their names. */
#define TRACE_ROW_MAX ((size_t)TRACE_ROW_COLUMNS * (DECIMAL_TEXT_MAX + 1))

_Static_assert(DECIMAL_TEXT_MAX > TRACE_COLUMN_NAME_MAX, "a row of names is no longer");

static void write_buffer(struct trace_writer *w)
{
    if (w->used > 0 && fwrite(w->buffer, 1, w->used, w->stream) != w->used)
        w->failed = true;
    w->used = 0;
}

void trace_writer_init(struct trace_writer *w, FILE *stream, unsigned axes, double cycle_s,
                       bool has_tool)
{
    unsigned count;

    w->stream = stream;
    w->failed = false;
    w->axes = axes;
    w->cycle_s = cycle_s;
    w->has_tool = has_tool;
    w->used = 0;
    count = trace_columns(axes, has_tool, w->column);
    for (unsigned i = 0; i < count; i++)
        w->used += (size_t)snprintf(w->buffer + w->used, TRACE_ROW_MAX, "%s%c", w->column[i].name,
                                    i + 1 < count ? ',' : '\n');
}

void trace_writer_add(struct trace_writer *w, const struct cycle_record *record,
                      const struct point *tool)
{
    double value[TRACE_ROW_COLUMNS];
    const unsigned count =
        trace_values(w->axes, w->cycle_s, record, w->has_tool ? tool : NULL, value);
    char *at;

    if (w->used > TRACE_BUFFER_SIZE - TRACE_ROW_MAX)
        write_buffer(w);
    at = w->buffer + w->used;
    for (unsigned i = 0; i < count; i++) {
        at += takt_decimal_write(at, value[i], w->column[i].places);
        *at++ = i + 1 < count ? ',' : '\n';
    }
    w->used = (size_t)(at - w->buffer);
}

bool trace_writer_flush(struct trace_writer *w)
{
    write_buffer(w);
    if (fflush(w->stream) != 0)
        w->failed = true;
    return !w->failed;
}
