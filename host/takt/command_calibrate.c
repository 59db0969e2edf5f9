/* takt calibrate: measure a correction table on the virtual machine. */
#include "cli/axis_unit.h"
#include "cli/message.h"
#include "config/correction_file.h"
#include "studies/calibration.h"
#include "takt/command.h"

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

/* AXIS_COUNT: it is the letter of none. */
static uint8_t axis_named(const char *name)
{
    const char *letter =
        name != NULL && strlen(name) == 1 ? strchr(AXIS_LETTERS, name[0] & ~0x20) : NULL;

    return letter != NULL ? (uint8_t)(letter - AXIS_LETTERS) : AXIS_COUNT;
}

/* The axis of an option, one that can be measured. AXIS_COUNT after a message. */
static uint8_t read_axis(const struct calibration *c, const char *option, const char *name)
{
    const uint8_t axis = axis_named(name);

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

/* ---- the table ---- */

static enum command_status write_result(const struct calibration *c, const struct options *options)
{
    const char *path = options->output != NULL ? options->output : "-";
    char comment[160];

    if (options->correction.comp != NULL)
        (void)snprintf(comment, sizeof comment, "from a file of nominal, forward, reverse");
    else if (options->correction.compose)
        (void)snprintf(comment, sizeof comment, "composed of the errors of the units of %.60s",
                       c->session.setup.machine.name);
    else
        (void)snprintf(comment, sizeof comment,
                       "measured on %.60s: %u points, noise %.3g um (1 sigma)",
                       c->session.setup.machine.name, (unsigned)takt_table_rows(&c->table),
                       1e3 * c->instrument.sigma);
    return correction_file_write(&c->table, path, comment) ? STATUS_DONE : STATUS_ENVIRONMENT;
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
static bool check_table(const struct calibration *c)
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

static bool set_task(struct calibration *c, const struct options *options)
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

/* A table that does not fit is refused before anything is measured, one with too large numbers afterwards. */
static enum command_status measure(struct calibration *c, const struct options *options)
{
    enum command_status status;

    if (!set_task(c, options) || !set_knots(c, options) || !check_table(c))
        return STATUS_INPUT;
    status = calibration_fill(c, options->correction.compose);
    if (status != STATUS_DONE)
        return status;
    return check_table(c) ? write_result(c, options) : STATUS_FAILED;
}

/* From LinuxCNC's file instead of a measurement. */
static enum command_status convert(struct calibration *c, const struct options *options)
{
    const enum axis axis = (enum axis)axis_named(options->correction.axis);

    if (axis == AXIS_COUNT) {
        message_command_error("--comp needs --axis, the axis its numbers are for");
        return STATUS_INPUT;
    }
    if (options->correction.comp_type > 1) {
        message_command_error("--comp-type is 0 (positions measured) or 1 (corrections)");
        return STATUS_INPUT;
    }
    if (!correction_file_read_triplets(&c->table, options->correction.comp, axis,
                                       (unsigned)options->correction.comp_type,
                                       &c->session.setup.machine))
        return STATUS_INPUT;
    return write_result(c, options);
}

static bool read_noise(const char *text, double *sigma_mm)
{
    char *end;
    double um = MEASUREMENT_NOISE;

    if (text != NULL) {
        um = strtod(text, &end);
        if (end == text || *end != '\0' || !isfinite(um) || um < 0) {
            message_command_error("--noise-um %s: a number, 0 or more, is expected", text);
            return false;
        }
    }
    *sigma_mm = 1e-3 * um;
    return true;
}

static enum command_status execute(struct calibration *c, const struct options *options)
{
    enum command_status status = session_open_machine(&c->session, options);

    if (status != STATUS_DONE)
        return status;
    if (!read_noise(options->correction.noise, &c->instrument.sigma))
        return STATUS_INPUT;
    c->instrument.state = UINT64_C(0x9E3779B97F4A7C15) * (1 + (uint64_t)options->correction.seed);
    if (options->correction.comp != NULL)
        return convert(c, options);
    if (options->correction.grid == NULL) {
        message_command_error("--grid is missing: how many points, such as 9x7x6, or 17 with "
                              "--axis X");
        return STATUS_INPUT;
    }
    return measure(c, options);
}

static enum command_status command_calibrate_execute(const struct options *options)
{
    struct calibration *c = calloc(1, sizeof *c);
    enum command_status status;

    if (c == NULL) {
        message_command_error("out of memory");
        return STATUS_ENVIRONMENT;
    }
    status = execute(c, options);
    calibration_close(c);
    free(c);
    return status;
}

static const struct option_row rows[] = {
    OPTIONS_MACHINE,
    {"grid", OPTION_TEXT, offsetof(struct options, correction.grid), "NxNxN",
     "points along X, Y, Z, a fourth number: the turning table; with --axis one number"},
    {"axis", OPTION_TEXT, offsetof(struct options, correction.axis), "AXIS",
     "a table over this axis alone, both directions of approach"},
    {"unit", OPTION_TEXT, offsetof(struct options, correction.unit), "AXIS",
     "the errors of this unit: three shifts, three turns (unit_table_x ...)"},
    {"compose", OPTION_FLAG, offsetof(struct options, correction.compose), NULL,
     "a volume table of the errors of units, without measuring: for boards"},
    {"from", OPTION_TEXT, offsetof(struct options, correction.from), "X,Y,Z",
     "first point (default: where the travel begins)"},
    {"to", OPTION_TEXT, offsetof(struct options, correction.to), "X,Y,Z",
     "last point (default: where it ends)"},
    {"noise-um", OPTION_TEXT, offsetof(struct options, correction.noise), "UM",
     "standard deviation of the instrument, um and urad (0.1)"},
    {"seed", OPTION_NUMBER, offsetof(struct options, correction.seed), "N", "of the noise (0)"},
    {"comp", OPTION_TEXT, offsetof(struct options, correction.comp), "FILE",
     "convert LinuxCNC's COMP_FILE of --axis instead of measuring"},
    {"comp-type", OPTION_NUMBER, offsetof(struct options, correction.comp_type), "0|1",
     "its COMP_FILE_TYPE: 0 positions measured (default), 1 corrections"},
    {"output", OPTION_TEXT, offsetof(struct options, output), "FILE",
     "or -o FILE: the table (default: standard output)"},
    OPTIONS_END,
};

const struct command command_calibrate = {
    .name = "calibrate",
    .usage = "--machine FILE --grid NxNxN [options]",
    .summary = "measure a correction table on the virtual machine",
    .help = "Sends the machine's drives to every point of a grid, from below and from above, waits "
            "until they have\n"
            "settled, and measures the deviation of the tool point. The table contains the "
            "correction. The errors of the\n"
            "machine are in [geometry] of the machine file. Layers of [correction] stay on while "
            "measuring, except the\n"
            "one that is measured, set-up and wear. So calibrate the volume first, name its table "
            "in the machine file,\n"
            "then calibrate the axes for backlash. Or measure the errors of each unit (--unit), "
            "which the controller\n"
            "composes along machine.chain; all layers that correct positions are off then. What "
            "the machine would not\n"
            "load is refused.\n"
            "\n"
            "Examples:\n"
            "  takt calibrate --machine worn_mill.ini --grid 9x7x6 -o volume.csv\n"
            "  takt calibrate --machine worn_mill.ini --axis X --grid 17 -o x.csv\n"
            "  takt calibrate --machine worn_mill.ini --unit X --grid 33 -o unit_x.csv\n"
            "  takt calibrate --comp x.comp --axis X -o x.csv\n",
    .options = rows,
    .operands_min = 0,
    .operands_max = 0,
    .run = command_calibrate_execute,
};
