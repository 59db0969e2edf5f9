#include "studies/calibration.h"

#include "cli/message.h"

#include <stdlib.h>

static void drop_axis_tables(struct axis_tables *tables, unsigned input)
{
    unsigned kept = 0;

    for (unsigned i = 0; i < tables->count; i++) {
        if (tables->pair[i].input != input)
            tables->pair[kept++] = tables->pair[i];
    }
    tables->count = kept;
    tables->inputs &= ~(1U << input);
}

/*
 * What is measured must not be corrected already, and a part that stands askew is no error of the
 * machine.
 */
static void switch_off(struct calibration *c)
{
    c->session.setup.machine.correction.off |= 1U << CORRECTION_SETUP | 1U << CORRECTION_WEAR;
    if (c->table.errors)
        c->session.setup.machine.correction.off |=
            1U << CORRECTION_MATRIX | 1U << CORRECTION_AXES | 1U << CORRECTION_VOLUME;
    if (c->session.correction == NULL || c->table.errors)
        return;
    if (c->table.inputs > 1)
        c->session.correction->volume.inputs = 0;
    else
        drop_axis_tables(&c->session.correction->axes, c->table.input[0]);
}

static bool plan_visits(struct calibration *c)
{
    const uint32_t rows = takt_table_rows(&c->table);

    c->visits = calloc(2 * (size_t)rows, sizeof *c->visits);
    if (c->visits == NULL) {
        message_command_error("out of memory");
        return false;
    }
    for (uint32_t row = 0; row < rows; row++) {
        struct measurement_visit *visit = &c->visits[2 * (size_t)row];
        uint32_t rest = row;

        for (unsigned i = 0; i < c->table.inputs; i++) {
            visit[0].at.at[c->table.input[i]] = c->table.knot_mm[i][rest % c->table.knots[i]];
            rest /= c->table.knots[i];
        }
        visit[0].direction = 1;
        visit[1].at = visit[0].at;
        visit[1].direction = -1;
    }
    return true;
}

/*
 * K is what takes the deviation back; without a direction, the mean of both. Of a unit the errors
 * are told themselves.
 */
static double value_of(const struct calibration *c, const struct measurement_visit visit[2],
                       const struct table_output *output)
{
    const double up = visit[0].deviation.at[output->axis];
    const double down = visit[1].deviation.at[output->axis];

    if (output->direction == TABLE_BOTH)
        return (c->table.errors ? 0.5 : -0.5) * (up + down);
    return output->direction == TABLE_UP ? -up : -down;
}

static void set_values(struct calibration *c)
{
    struct table *table = &c->table;
    const uint32_t rows = takt_table_rows(table);

    for (uint32_t row = 0; row < rows; row++) {
        for (unsigned i = 0; i < table->outputs; i++)
            table->value_mm[row * table->outputs + i] =
                (float)value_of(c, &c->visits[2 * (size_t)row], &table->output[i]);
    }
}

/*
 * The volume table that the errors of all units make together: for controllers without them, on
 * boards.
 */
static void compose(struct calibration *c)
{
    struct table *table = &c->table;
    const uint32_t rows = takt_table_rows(table);

    for (uint32_t row = 0; row < rows; row++) {
        double deviation[AXIS_COUNT];

        (void)takt_geometry_deviation(c->session.correction->geometry,
                                      &c->visits[2 * (size_t)row].at, deviation);
        for (unsigned i = 0; i < table->outputs; i++)
            table->value_mm[row * table->outputs + i] = (float)-deviation[table->output[i].axis];
    }
}

enum command_status calibration_fill(struct calibration *c, bool composes)
{
    enum command_status status;

    if (!plan_visits(c))
        return STATUS_ENVIRONMENT;
    if (composes) {
        compose(c);
        return STATUS_DONE;
    }
    switch_off(c);
    status =
        measurement_run(&c->session, c->visits, 2 * takt_table_rows(&c->table), &c->instrument);
    if (status == STATUS_DONE)
        set_values(c);
    return status;
}

void calibration_close(struct calibration *c)
{
    session_close(&c->session);
    free(c->visits);
}
