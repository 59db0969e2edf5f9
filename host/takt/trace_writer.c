#include "takt/trace_writer.h"

#include "base/decimal.h"
#include "takt/axis_unit.h"

#include <stdarg.h>

/* Numbers of a row: cycle, time, block, line, feed, override, limiter, three of every axis, the spindle's angle. */
#define TRACE_ROW_MAX ((size_t)(8 + 3 * AXIS_COUNT) * (DECIMAL_TEXT_MAX + 1))

#define TRACE_PLACES_POSITION 9
#define TRACE_PLACES_TIME     6
#define TRACE_PLACES_FEED     6
#define TRACE_PLACES_RATIO    6

static void write_buffer(struct trace_writer *w)
{
    if (w->used > 0 && fwrite(w->buffer, 1, w->used, w->stream) != w->used)
        w->failed = true;
    w->used = 0;
}

__attribute__((format(printf, 2, 3))) static void add_text(struct trace_writer *w,
                                                           const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    w->used += (size_t)vsnprintf(w->buffer + w->used, TRACE_ROW_MAX, format, arguments);
    va_end(arguments);
}

void trace_writer_init(struct trace_writer *w, FILE *stream, unsigned axes, double cycle_s)
{
    w->stream = stream;
    w->failed = false;
    w->axes = axes;
    w->cycle_s = cycle_s;
    w->used = 0;
    add_text(w, "cycle,time_s,block,line,feed_mm_min,override_percent,limiter");
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (axes & 1u << i) {
            char letter = AXIS_LETTERS[i];
            const char *unit = axis_unit_name(i);

            add_text(w, ",cmd_%c_%s,set_%c_%s,act_%c_%s", letter, unit, letter, unit, letter, unit);
        }
    }
    add_text(w, ",spindle_rev\n");
}

static char *put(char *at, double value, unsigned places)
{
    at += decimal_write(at, value, places);
    *at = ',';
    return at + 1;
}

void trace_writer_add(struct trace_writer *w, const struct cycle_record *record)
{
    char *at;

    if (w->used > TRACE_BUFFER_SIZE - TRACE_ROW_MAX)
        write_buffer(w);
    at = w->buffer + w->used;
    at = put(at, (double)record->cycle, 0);
    at = put(at, (double)record->cycle * w->cycle_s, TRACE_PLACES_TIME);
    at = put(at, record->block, 0);
    at = put(at, record->line, 0);
    at = put(at, record->feed_mm_s * 60.0, TRACE_PLACES_FEED);
    at = put(at, record->override_percent, TRACE_PLACES_RATIO);
    at = put(at, record->limiter, TRACE_PLACES_RATIO);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        double ratio = axis_unit_ratio(i);

        if (w->axes & 1u << i) {
            at = put(at, record->cmd.at[i] * ratio, TRACE_PLACES_POSITION);
            at = put(at, record->set.at[i] * ratio, TRACE_PLACES_POSITION);
            at = put(at, record->act.at[i] * ratio, TRACE_PLACES_POSITION);
        }
    }
    at = put(at, record->spindle_rev, TRACE_PLACES_POSITION);
    at[-1] = '\n';
    w->used = (size_t)(at - w->buffer);
}

bool trace_writer_flush(struct trace_writer *w)
{
    write_buffer(w);
    if (fflush(w->stream) != 0)
        w->failed = true;
    return !w->failed;
}
