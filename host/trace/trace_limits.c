/* takt trace: peaks of a trace beside the limits of a machine. */
#include "trace/trace_check.h"

#include "base/maths.h"
#include "cli/axis_unit.h"
#include "cli/message.h"
#include "verifier/verifier.h"

#include <stdio.h>

#define ORDERS 3 /* velocity, acceleration, jerk */

/* One derivative of one axis. */
struct limit_watch {
    double limit; /* in the trace's unit */
    double ratio; /* above 1: room for rounding */
    double peak;
    uint64_t over; /* cycles */
    double first_cycle, first_block, first_line;
};

struct axis_watch {
    unsigned axis;
    int column;
    double last[ORDERS]; /* position, velocity, acceleration of the row before */
    struct limit_watch watch[ORDERS];
};

struct limits_watch {
    struct trace_reader *reader;
    int cycle, time, block, line; /* columns; -1: not there */
    uint64_t rows;
    double first_time_s, last_time_s;
    double cycle_s;
    unsigned axes;
    struct axis_watch axis[AXIS_COUNT];
};

/* Column of an axis, which trace and machine both have or neither has; else it is told. */
static bool find_axis(const struct limits_watch *w, bool present, unsigned axis, int *column)
{
    char name[16];

    (void)snprintf(name, sizeof name, "set_%c_%s", AXIS_LETTERS[axis], axis_unit_name(axis));
    *column = trace_reader_find(w->reader, name);
    if (*column >= 0 && !present) {
        message_error(w->reader->name, 1, 0,
                      "column %s: the machine has no axis %c: name the trace's own by --machine",
                      name, AXIS_LETTERS[axis]);
        return false;
    }
    if (*column < 0 && present)
        message_warning(w->reader->name, 1, 0,
                        "no column %s: this axis of the machine is not judged", name);
    return true;
}

static bool find_axes(struct limits_watch *w, const struct machine *machine)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct machine_axis *axis = &machine->axis[i];
        double unit = axis_unit_ratio(i);
        int column;

        if (!find_axis(w, axis->present, i, &column))
            return false;
        if (column < 0)
            continue;
        w->axis[w->axes++] = (struct axis_watch){
            .axis = i,
            .column = column,
            .watch = {{.limit = axis->max_velocity_mm_s * unit, .ratio = VERIFIER_VELOCITY_RATIO},
                      {.limit = axis->max_acceleration_mm_s2 * unit,
                       .ratio = VERIFIER_ACCELERATION_RATIO},
                      {.limit = axis->max_jerk_mm_s3 * unit, .ratio = VERIFIER_JERK_RATIO}},
        };
    }
    if (w->axes == 0)
        message_error(w->reader->name, 1, 0,
                      "no column set_X_mm or the like of an axis of this machine");
    return w->axes > 0;
}

static double column_value(const struct limits_watch *w, int column)
{
    return column >= 0 ? w->reader->value[column] : 0;
}

static void watch_value(const struct limits_watch *w, struct limit_watch *watch, double value)
{
    value = maths_abs(value);
    if (value > watch->peak)
        watch->peak = value;
    if (value <= watch->limit * watch->ratio)
        return;
    if (watch->over++ == 0) {
        watch->first_cycle = column_value(w, w->cycle);
        watch->first_block = column_value(w, w->block);
        watch->first_line = column_value(w, w->line);
    }
}

/*
 * Differences: the first row gives a position, the second a velocity, the third an acceleration,
 * the fourth a jerk.
 */
static void watch_axis(const struct limits_watch *w, struct axis_watch *axis)
{
    double value = w->reader->value[axis->column];

    for (unsigned order = 0; order < ORDERS && order < w->rows; order++) {
        double difference = (value - axis->last[order]) / w->cycle_s;

        axis->last[order] = value;
        watch_value(w, &axis->watch[order], difference);
        value = difference;
    }
    if (w->rows < ORDERS)
        axis->last[w->rows] = value;
}

/* Rows that follow one another by a cycle each, or differences say nothing. */
static bool watch_time(struct limits_watch *w)
{
    const double time_s = w->reader->value[w->time];
    const double step_s = time_s - w->last_time_s;

    if (w->rows == 0)
        w->first_time_s = time_s;
    if (w->rows == 1) /* whole microseconds, as cycles are */
        w->cycle_s = takt_maths_round(step_s * 1e6) * 1e-6;
    w->last_time_s = time_s;
    if (w->rows == 0 || (w->cycle_s > 0 && maths_abs(step_s - w->cycle_s) < 0.5 * w->cycle_s))
        return true;
    message_error(
        w->reader->name, w->reader->line, 0,
        "time_s is %.9g s behind the row before, where a cycle is %.9g s: rows are missing "
        "or not in order",
        step_s, w->cycle_s);
    return false;
}

static void watch_row(struct limits_watch *w)
{
    for (unsigned i = 0; i < w->axes; i++)
        watch_axis(w, &w->axis[i]);
    w->rows++;
}

static bool print_order(const struct axis_watch *axis, unsigned order)
{
    static const char *const names[ORDERS] = {"velocity", "acceleration", "jerk"};
    static const char *const per[ORDERS] = {"s", "s2", "s3"};
    const struct limit_watch *watch = &axis->watch[order];

    (void)printf("  %c %-12s %14.6f of %12.6f %s/%-2s %6.2f %%", AXIS_LETTERS[axis->axis],
                 names[order], watch->peak, watch->limit, axis_unit_name(axis->axis), per[order],
                 100 * watch->peak / watch->limit);
    if (watch->over > 0)
        (void)printf("  BROKEN in %llu cycles, first in cycle %.0f, block %.0f, line %.0f",
                     (unsigned long long)watch->over, watch->first_cycle, watch->first_block,
                     watch->first_line);
    (void)printf("\n");
    return watch->over == 0;
}

static enum command_status print_limits(const struct limits_watch *w)
{
    bool held = true;

    (void)printf("%s: %llu cycles, %.6f s\n", w->reader->name, (unsigned long long)w->rows,
                 w->last_time_s - w->first_time_s);
    for (unsigned i = 0; i < w->axes; i++) {
        for (unsigned order = 0; order < ORDERS; order++)
            held = print_order(&w->axis[i], order) && held;
    }
    return held ? STATUS_DONE : STATUS_FAILED;
}

enum command_status trace_check_limits(struct trace_reader *r, const struct machine *machine)
{
    struct limits_watch w = {
        .reader = r,
        .cycle = trace_reader_find(r, "cycle"),
        .time = trace_reader_find(r, "time_s"),
        .block = trace_reader_find(r, "block"),
        .line = trace_reader_find(r, "line"),
        .cycle_s = 1e-6 * (double)machine->cycle_us,
    };
    enum trace_row row;

    if (!find_axes(&w, machine))
        return STATUS_INPUT;
    while ((row = trace_reader_next(r)) == TRACE_ROW) {
        if (!watch_time(&w))
            return STATUS_INPUT;
        watch_row(&w);
    }
    return row == TRACE_BAD ? STATUS_INPUT : print_limits(&w);
}
