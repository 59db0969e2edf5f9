#include "studies/calibration_task.h"

#include "cli/axis_unit.h"
#include "cli/message.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool is_axis(const struct calibration *c, unsigned axis)
{
    return c->session.setup.machine.axis[axis].present;
}

/* The axis that turns the part on this machine; AXIS_COUNT: none. */
static unsigned turn_axis(const struct calibration *c)
{
    struct unit_chain chain;

    (void)machine_setup_chain(&c->session.setup, &chain);
    return chain.axis[chain.units - 1] < AXIS_LINEAR_COUNT ? AXIS_COUNT
                                                           : chain.axis[chain.units - 1];
}

/* ---- what is to be measured ---- */

/* "9x7x6": points along each input. */
static bool read_grid(const char *text, unsigned inputs, unsigned points[TABLE_INPUTS_MAX])
{
    for (unsigned i = 0; i < inputs; i++) {
        char *end;
        const long number = strtol(text, &end, 10);

        if (end == text || number < 2 || number > TABLE_KNOTS_MAX ||
            *end != (i + 1 < inputs ? 'x' : '\0'))
            return false;
        points[i] = (unsigned)number;
        text = end + 1;
    }
    return true;
}

/* "0,0,-250": a position of each input, in mm and degrees. */
static bool read_positions(const char *text, const struct table *table, double mm[TABLE_INPUTS_MAX])
{
    for (unsigned i = 0; i < table->inputs; i++) {
        char *end;

        mm[i] = strtod(text, &end) / axis_unit_ratio(table->input[i]);
        if (end == text || !isfinite(mm[i]) || *end != (i + 1U < table->inputs ? ',' : '\0'))
            return false;
        text = end + 1;
    }
    return true;
}

static bool check_range(const struct calibration *c, unsigned input, double from, double to)
{
    const unsigned axis = c->table.input[input];
    const struct machine_axis *of = &c->session.setup.machine.axis[axis];

    if (from < to && from >= of->travel_min_mm - 1e-9 && to <= of->travel_max_mm + 1e-9)
        return true;
    message_command_error(
        "axis %c: it cannot be measured from %.9g to %.9g %s: its travel is %.9g to %.9g",
        AXIS_LETTERS[axis], from * axis_unit_ratio(axis), to * axis_unit_ratio(axis),
        axis_unit_name(axis), of->travel_min_mm * axis_unit_ratio(axis),
        of->travel_max_mm * axis_unit_ratio(axis));
    return false;
}

static bool set_knots(struct calibration *c, const struct options *options)
{
    struct table *table = &c->table;
    unsigned points[TABLE_INPUTS_MAX];
    double from[TABLE_INPUTS_MAX], to[TABLE_INPUTS_MAX];

    if (!read_grid(options->correction.grid, table->inputs, points)) {
        message_command_error("--grid %s: points along %s are expected, 2 to %d each, such as %s",
                              options->correction.grid,
                              table->inputs == 1 ? "the axis" : "X, Y, Z (and the turning axis)",
                              TABLE_KNOTS_MAX, table->inputs == 1 ? "17" : "9x7x6");
        return false;
    }
    for (unsigned i = 0; i < table->inputs; i++) {
        from[i] = c->session.setup.machine.axis[table->input[i]].travel_min_mm;
        to[i] = c->session.setup.machine.axis[table->input[i]].travel_max_mm;
    }
    if ((options->correction.from != NULL &&
         !read_positions(options->correction.from, table, from)) ||
        (options->correction.to != NULL && !read_positions(options->correction.to, table, to))) {
        message_command_error("--from and --to: %u positions are expected, separated by commas",
                              table->inputs);
        return false;
    }
    for (unsigned i = 0; i < table->inputs; i++) {
        if (!check_range(c, i, from[i], to[i]))
            return false;
        table->knots[i] = (uint16_t)points[i];
        for (unsigned k = 0; k < points[i]; k++)
            table->knot_mm[i][k] = from[i] + (to[i] - from[i]) * k / (points[i] - 1);
    }
    if ((uint64_t)takt_table_rows(table) * table->outputs <= TABLE_VALUES_MAX)
        return true;
    message_command_error("--grid %s: these are more than %d numbers", options->correction.grid,
                          TABLE_VALUES_MAX);
    return false;
}

/* A volume: the linear axes, and the turning axis if the grid has a fourth number. */
static bool set_volume(struct calibration *c, const char *grid)
{
    unsigned numbers = 1;

    for (const char *at = strchr(grid, 'x'); at != NULL; at = strchr(at + 1, 'x'))
        numbers++;
    for (uint8_t i = 0; i < AXIS_LINEAR_COUNT; i++) {
        if (is_axis(c, i)) {
            c->table.input[c->table.inputs++] = i;
            c->table.output[c->table.outputs++] = (struct table_output){i, TABLE_BOTH};
        }
    }
    if (numbers <= AXIS_LINEAR_COUNT)
        return true;
    if (turn_axis(c) == AXIS_COUNT || !is_axis(c, turn_axis(c))) {
        message_command_error("--grid %s: the machine has no turning table (geometry.table_axis, "
                              "machine.chain)",
                              grid);
        return false;
    }
    c->table.input[c->table.inputs++] = (uint8_t)turn_axis(c);
    c->table.output[c->table.outputs++] = (struct table_output){(uint8_t)turn_axis(c), TABLE_BOTH};
    c->instrument.on_table = true; /* what the table is off in its angle is corrected there */
    return true;
}

uint8_t calibration_axis_named(const char *name)
{
    const char *letter =
        name != NULL && strlen(name) == 1 ? strchr(AXIS_LETTERS, name[0] & ~0x20) : NULL;

    return letter != NULL ? (uint8_t)(letter - AXIS_LETTERS) : AXIS_COUNT;
}

/* The axis of an option, one that can be measured. AXIS_COUNT after a message. */
static uint8_t read_axis(const struct calibration *c, const char *option, const char *name)
{
    const uint8_t axis = calibration_axis_named(name);

    if (axis < AXIS_COUNT && is_axis(c, axis) && (axis < AXIS_LINEAR_COUNT || axis == turn_axis(c)))
        return axis;
    message_command_error("%s %s: a linear axis of the machine, or its turning table, is expected",
                          option, name);
    return AXIS_COUNT;
}

/* A unit: three shifts and three turns. */
static bool set_unit(struct calibration *c, const char *name)
{
    const uint8_t axis = read_axis(c, "--unit", name);

    c->table.input[c->table.inputs++] = axis;
    c->table.errors = true;
    c->instrument.unit = axis;
    for (uint8_t i = 0; i < DEVIATION_OF_AXIS; i++)
        c->table.output[c->table.outputs++] = (struct table_output){i, TABLE_BOTH};
    return axis < AXIS_COUNT;
}

/* One axis: its own error in both directions, and what it does to the others. */
static bool set_axis(struct calibration *c, const char *name)
{
    const uint8_t axis = read_axis(c, "--axis", name);

    if (axis == AXIS_COUNT)
        return false;
    c->table.input[c->table.inputs++] = axis;
    c->table.output[c->table.outputs++] = (struct table_output){axis, TABLE_UP};
    c->table.output[c->table.outputs++] = (struct table_output){axis, TABLE_DOWN};
    for (uint8_t i = 0; i < AXIS_LINEAR_COUNT && axis < AXIS_LINEAR_COUNT; i++) {
        if (i != axis && is_axis(c, i))
            c->table.output[c->table.outputs++] = (struct table_output){i, TABLE_BOTH};
    }
    return true;
}

/* ---- whether the machine can use the table ---- */

static bool fits_grid(const struct table *table, struct diagnostic *wrong)
{
    struct grid *grid = calloc(1, sizeof *grid);
    const bool fits = grid != NULL && takt_grid_set(grid, table, wrong);

    free(grid);
    return fits;
}

/* By the rules that the machine file has for tables, as when it is loaded. */
bool calibration_check(const struct calibration *c)
{
    const struct machine *machine = &c->session.setup.machine;
    char text[DIAGNOSTIC_TEXT_MAX];
    struct diagnostic wrong = {0};
    struct table_rules rules;

    takt_correction_table_rules(&machine->correction, takt_machine_axes(machine), &rules);
    if (takt_table_check(&c->table, &rules, &wrong) &&
        (c->table.inputs == 1 || fits_grid(&c->table, &wrong)))
        return true;
    (void)takt_diagnostic_text(&wrong, text);
    message_command_error("this machine would refuse the table: %s", text);
    return false;
}

static bool set_table(struct calibration *c, const struct options *options)
{
    c->instrument.unit = AXIS_COUNT;
    if (options->correction.compose &&
        (c->session.correction == NULL || c->session.correction->geometry == NULL)) {
        message_command_error("--compose: the machine file names no errors of units "
                              "(unit_table_..., squareness_urad)");
        return false;
    }
    if (options->correction.unit != NULL)
        return set_unit(c, options->correction.unit);
    return options->correction.axis != NULL ? set_axis(c, options->correction.axis)
                                            : set_volume(c, options->correction.grid);
}

bool calibration_set(struct calibration *c, const struct options *options)
{
    return set_table(c, options) && set_knots(c, options) && calibration_check(c);
}
