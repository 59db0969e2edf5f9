#include "results/trace_row.h"

#include "cli/axis_unit.h"

#include <stddef.h>
#include <stdio.h>

#define PLACES_POSITION 9
#define PLACES_TIME     6
#define PLACES_FEED     6
#define PLACES_RATIO    6

static unsigned add_column(struct trace_column *column, unsigned count, const char *name,
                           unsigned places)
{
    (void)snprintf(column[count].name, sizeof column[count].name, "%.*s", TRACE_COLUMN_NAME_MAX,
                   name);
    column[count].places = places;
    return count + 1;
}

/* "cmd_X_mm" */
static unsigned add_of_axis(struct trace_column *column, unsigned count, const char *kind,
                            unsigned axis)
{
    (void)snprintf(column[count].name, sizeof column[count].name, "%s_%c_%s", kind,
                   AXIS_LETTERS[axis], axis_unit_name(axis));
    column[count].places = PLACES_POSITION;
    return count + 1;
}

unsigned trace_columns(unsigned axes, bool has_tool, struct trace_column column[TRACE_ROW_COLUMNS])
{
    static const struct trace_column first[] = {{"cycle", 0},
                                                {"time_s", PLACES_TIME},
                                                {"block", 0},
                                                {"line", 0},
                                                {"feed_mm_min", PLACES_FEED},
                                                {"override_percent", PLACES_RATIO},
                                                {"limiter", PLACES_RATIO}};
    unsigned count = 0;

    for (size_t i = 0; i < sizeof first / sizeof first[0]; i++)
        count = add_column(column, count, first[i].name, first[i].places);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if ((axes & 1u << i) == 0)
            continue;
        count = add_of_axis(column, count, "cmd", i);
        count = add_of_axis(column, count, "set", i);
        count = add_of_axis(column, count, "act", i);
    }
    count = add_column(column, count, "spindle_rev", PLACES_POSITION);
    for (unsigned i = 0; has_tool && i < AXIS_LINEAR_COUNT; i++)
        count = add_of_axis(column, count, "tool", i);
    return count;
}

unsigned trace_values(unsigned axes, double cycle_s, const struct cycle_record *record,
                      const struct point *tool, double value[TRACE_ROW_COLUMNS])
{
    unsigned count = 0;

    value[count++] = (double)record->cycle;
    value[count++] = (double)record->cycle * cycle_s;
    value[count++] = record->block;
    value[count++] = record->line;
    value[count++] = record->feed_mm_s * 60.0;
    value[count++] = record->override_percent;
    value[count++] = record->limiter;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const double ratio = axis_unit_ratio(i);

        if ((axes & 1u << i) == 0)
            continue;
        value[count++] = record->cmd.at[i] * ratio;
        value[count++] = record->set.at[i] * ratio;
        value[count++] = record->act.at[i] * ratio;
    }
    value[count++] = record->spindle_rev;
    for (unsigned i = 0; tool != NULL && i < AXIS_LINEAR_COUNT; i++)
        value[count++] = tool->at[i];
    return count;
}
