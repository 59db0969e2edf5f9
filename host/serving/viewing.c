#include "serving/viewing.h"

#include "base/maths.h"
#include "cli/axis_unit.h"
#include "cli/message.h"
#include "drive/drives.h"
#include "trace/trace_reader.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ROWS_FIRST      4096
#define COUNTS_PER_UNIT 1000.0
#define TENTHS          10.0
#define FULL_OVERRIDE   1000U
#define LIMITER_COUNTS  10000.0

struct columns {
    int set[AXIS_COUNT], actual[AXIS_COUNT], line, block, feed, override_percent, limiter, time;
};

/* ---- reading ---- */

static void find_columns(const struct trace_reader *r, const struct machine *machine,
                         struct columns *c)
{
    char name[16];

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        (void)snprintf(name, sizeof name, "set_%c_%s", AXIS_LETTERS[i], axis_unit_name(i));
        c->set[i] = machine->axis[i].present ? trace_reader_find(r, name) : -1;
        (void)snprintf(name, sizeof name, "act_%c_%s", AXIS_LETTERS[i], axis_unit_name(i));
        c->actual[i] = trace_reader_find(r, name);
    }
    c->line = trace_reader_find(r, "line");
    c->block = trace_reader_find(r, "block");
    c->feed = trace_reader_find(r, "feed_mm_min");
    c->override_percent = trace_reader_find(r, "override_percent");
    c->limiter = trace_reader_find(r, "limiter");
    c->time = trace_reader_find(r, "time_s");
}

static double value_of(const struct trace_reader *r, int column, double otherwise)
{
    return column >= 0 ? r->value[column] : otherwise;
}

static uint32_t whole_of(const struct trace_reader *r, int column)
{
    return (uint32_t)maths_clamp(value_of(r, column, 0), 0, UINT32_MAX);
}

static void read_row(const struct trace_reader *r, const struct columns *c, struct view_row *row)
{
    memset(row, 0, sizeof *row);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        row->set.at[i] = value_of(r, c->set[i], 0) / axis_unit_ratio(i);
        row->actual.at[i] =
            value_of(r, c->actual[i], row->set.at[i] * axis_unit_ratio(i)) / axis_unit_ratio(i);
    }
    row->line = whole_of(r, c->line);
    row->block = whole_of(r, c->block);
    row->feed_mm_min = (float)value_of(r, c->feed, 0);
    row->override_percent = (float)value_of(r, c->override_percent, 100);
    row->limiter = (float)value_of(r, c->limiter, 1);
}

/* NULL: out of memory, after a message. */
static struct view_row *add_row(struct viewing *v)
{
    const size_t room = v->room > 0 ? 2 * v->room : ROWS_FIRST;

    if (v->count == v->room) {
        struct view_row *row = realloc(v->row, room * sizeof *row);
        if (row == NULL) {
            message_command_error("out of memory");
            return NULL;
        }
        v->row = row;
        v->room = room;
    }
    return &v->row[v->count++];
}

/* The cycle time is that of the trace. */
static bool read_rows(struct viewing *v, struct trace_reader *r, const struct columns *c)
{
    enum trace_row result;
    double first_s = 0;

    while ((result = trace_reader_next(r)) == TRACE_ROW) {
        struct view_row *row = add_row(v);

        if (row == NULL)
            return false;
        read_row(r, c, row);
        first_s = v->count == 1 ? r->value[c->time] : first_s;
        v->cycle_s = v->count == 1 ? 0 : (r->value[c->time] - first_s) / (double)(v->count - 1);
    }
    if (result == TRACE_END && !(v->count > 1 && v->cycle_s > 0))
        message_error(r->name, r->line, 0, "two rows whose time rises are needed at least");
    return result == TRACE_END && v->count > 1 && v->cycle_s > 0;
}

bool viewing_open(struct viewing *v, const char *path, const struct machine *machine, double speed)
{
    struct trace_reader reader;
    struct columns columns;
    bool good = trace_reader_open(&reader, path);

    *v = (struct viewing){.machine = machine,
                          .speed = speed,
                          .state = PANEL_RUNNING,
                          .override_counts = FULL_OVERRIDE};
    if (good) {
        find_columns(&reader, machine, &columns);
        good = read_rows(v, &reader, &columns);
    }
    trace_reader_close(&reader);
    return good;
}

void viewing_close(struct viewing *v)
{
    free(v->row);
    v->row = NULL;
}

/* ---- orders ---- */

/* Row at which a line is played first; the first row if it never is. */
static double row_of_line(const struct viewing *v, uint32_t line)
{
    for (size_t i = 0; i < v->count; i++) {
        if (line != 0 && v->row[i].line == line)
            return (double)i;
    }
    return 0;
}

static void start(struct viewing *v)
{
    if (v->state == PANEL_IDLE) {
        v->at = row_of_line(v, v->start_line);
        v->start_line = 0;
        v->cycles += 2; /* a gap: no difference is taken over it */
    }
    v->state = PANEL_RUNNING;
}

static enum panel_verdict take_item(struct viewing *v, const struct panel_order_item *item)
{
    const bool on = item->value != 0;

    if ((item->id == REGISTER_CYCLE_START || item->id == REGISTER_RESUME) && on)
        start(v);
    else if (item->id == REGISTER_FEED_HOLD && on && v->state == PANEL_RUNNING)
        v->state = PANEL_HELD;
    else if (item->id == REGISTER_RESET && on)
        v->state = PANEL_IDLE;
    else if (item->id == REGISTER_START_LINE)
        v->start_line = (uint32_t)item->value;
    else if (item->id == REGISTER_FEED_OVERRIDE)
        v->override_counts = (uint32_t)item->value;
    else if (item->id == REGISTER_WATCHDOG)
        v->watchdog_ms = 0; /* there is nothing to be in control of */
    else if (on)
        return PANEL_WRONG_STATE;
    return PANEL_DONE;
}

enum panel_verdict viewing_order(struct viewing *v, const struct panel_order *order)
{
    enum panel_verdict verdict = PANEL_DONE;

    for (unsigned i = 0; i < order->count && verdict == PANEL_DONE; i++)
        verdict = take_item(v, &order->item[i]);
    return verdict;
}

/* ---- playing ---- */

static const struct view_row *row_at(const struct viewing *v, size_t back)
{
    const size_t at = (size_t)v->at;

    return &v->row[at >= back ? at - back : 0];
}

/* A position that is reported belongs to a setpoint of some cycles ago. */
static void put_row(struct viewing *v, struct page_link *link)
{
    struct page_cycle cycle = {.number = ++v->cycles, .set = row_at(v, 0)->set};

    for (unsigned i = 0; i < AXIS_COUNT; i++)
        cycle.following.at[i] =
            row_at(v, DRIVES_LATENCY_CYCLES)->set.at[i] - row_at(v, 0)->actual.at[i];
    page_link_put(link, &cycle);
}

void viewing_cycle(struct viewing *v, struct page_link *link)
{
    const double step = v->speed * (double)v->override_counts / (double)FULL_OVERRIDE;
    const double last = (double)(v->count - 1);
    double to;

    if (v->state != PANEL_RUNNING)
        return;
    to = v->at + step < last ? v->at + step : last;
    for (size_t next = (size_t)v->at + 1; next <= (size_t)to; next++) {
        v->at = (double)next;
        put_row(v, link);
    }
    v->at = to;
    if (to >= last) {
        v->state = PANEL_IDLE;
        v->runs++;
    }
}

static uint32_t counts(double value, double per_unit)
{
    return (uint32_t)(int64_t)takt_maths_round(
        maths_clamp(value * per_unit, -INT32_MAX, INT32_MAX));
}

static void look_at_axes(const struct viewing *v, uint32_t *value)
{
    const struct view_row *row = row_at(v, 0), *before = row_at(v, 1);

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const double unit = axis_unit_ratio(i) * COUNTS_PER_UNIT;

        value[REGISTER_POSITION_X + i] = counts(row->set.at[i], unit);
        value[REGISTER_WORK_POSITION_X + i] = value[REGISTER_POSITION_X + i];
        value[REGISTER_ACTUAL_X + i] = counts(row->actual.at[i], unit);
        value[REGISTER_FOLLOWING_X + i] =
            counts(row_at(v, DRIVES_LATENCY_CYCLES)->set.at[i] - row->actual.at[i], unit);
        if (v->state == PANEL_RUNNING)
            value[REGISTER_AXIS_FEED_X + i] =
                counts((row->set.at[i] - before->set.at[i]) * 60.0 / v->cycle_s, unit);
    }
    value[REGISTER_AXES] = takt_machine_axes(v->machine);
    value[REGISTER_HOMED] = value[REGISTER_AXES];
}

void viewing_look(const struct viewing *v, struct panel_snapshot *snapshot)
{
    const struct view_row *row = row_at(v, 0);
    uint32_t *value = snapshot->value;

    memset(snapshot, 0, sizeof *snapshot);
    look_at_axes(v, value);
    value[REGISTER_STATE] = v->state;
    value[REGISTER_HOLD_REASON] = v->state == PANEL_HELD ? PANEL_HOLD_OPERATOR : PANEL_HOLD_NONE;
    value[REGISTER_ACTIVE_LINE] = v->state != PANEL_IDLE ? row->line : 0;
    value[REGISTER_BLOCK] = row->block;
    value[REGISTER_FEED] = v->state == PANEL_RUNNING ? counts((double)row->feed_mm_min, TENTHS) : 0;
    value[REGISTER_OVERRIDE_EFFECTIVE] = counts((double)row->override_percent, TENTHS);
    value[REGISTER_LIMITER] = counts((double)row->limiter, LIMITER_COUNTS);
    value[REGISTER_FEED_OVERRIDE] = v->override_counts;
    value[REGISTER_RAPID_OVERRIDE] = value[REGISTER_SPINDLE_OVERRIDE] = FULL_OVERRIDE;
    value[REGISTER_START_LINE] = v->start_line;
    value[REGISTER_WORK_SYSTEM] = value[REGISTER_SYSTEM] = 1;
    value[REGISTER_PROGRAM_SIZE] = (uint32_t)v->count;
    value[REGISTER_CYCLES] = v->cycles;
    value[REGISTER_RUNS] = v->runs;
    value[REGISTER_CYCLE_START] = v->state == PANEL_RUNNING;
}
