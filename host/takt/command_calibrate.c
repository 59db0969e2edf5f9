/* takt calibrate: measure a correction table on the virtual machine. */
#include "cli/message.h"
#include "config/correction_file.h"
#include "studies/calibration_task.h"
#include "takt/command.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

/*
 * A table that does not fit is refused before anything is measured, one with too large numbers
 * afterwards.
 */
static enum command_status measure(struct calibration *c, const struct options *options)
{
    enum command_status status;

    if (!calibration_set(c, options))
        return STATUS_INPUT;
    status = calibration_fill(c, options->correction.compose);
    if (status != STATUS_DONE)
        return status;
    return calibration_check(c) ? write_result(c, options) : STATUS_FAILED;
}

/* From LinuxCNC's file instead of a measurement. */
static enum command_status convert(struct calibration *c, const struct options *options)
{
    const enum axis axis = (enum axis)calibration_axis_named(options->correction.axis);

    if (axis == AXIS_COUNT) {
        message_command_error("--comp needs --axis, the axis its numbers are for");
        return STATUS_INPUT;
    }
    if (options->correction.comp_type > 1) {
        message_command_error("--comp-type is 0 (positions measured) or 1 (corrections)");
        return STATUS_INPUT;
    }
    if (!correction_file_read_triplets(&c->table, options->correction.comp, axis,
                                       options->correction.comp_type, &c->session.setup.machine))
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

/* A table is measured, composed or converted: what would be left aside is refused. */
static bool check_options(const struct option_correction *o)
{
    const struct {
        const char *name, *other;
        bool both;
    } pairs[] = {
        {"comp", "grid", o->comp != NULL && o->grid != NULL},
        {"comp", "unit", o->comp != NULL && o->unit != NULL},
        {"comp", "compose", o->comp != NULL && o->compose},
        {"comp", "from", o->comp != NULL && o->from != NULL},
        {"comp", "to", o->comp != NULL && o->to != NULL},
        {"comp", "noise-um", o->comp != NULL && o->noise != NULL},
        {"unit", "axis", o->unit != NULL && o->axis != NULL},
        {"compose", "unit", o->compose && o->unit != NULL},
        {"compose", "axis", o->compose && o->axis != NULL},
        {"compose", "noise-um", o->compose && o->noise != NULL},
    };

    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        if (pairs[i].both) {
            message_command_error("--%s and --%s: only one of them can be", pairs[i].name,
                                  pairs[i].other);
            return false;
        }
    }
    if (o->comp == NULL && o->comp_type != 0)
        message_command_error("--comp-type says what is in the file of --comp, which is missing");
    return o->comp != NULL || o->comp_type == 0;
}

static enum command_status execute(struct calibration *c, const struct options *options)
{
    enum command_status status = check_options(&options->correction)
                                     ? session_open_machine(&c->session, options)
                                     : STATUS_INPUT;

    if (status != STATUS_DONE)
        return status;
    if (!read_noise(options->correction.noise, &c->instrument.sigma))
        return STATUS_INPUT;
    c->instrument.state = UINT64_C(0x9E3779B97F4A7C15) * (UINT64_C(1) + options->correction.seed);
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
    {"seed", OPTION_WHOLE, offsetof(struct options, correction.seed), "N", "of the noise (0)"},
    {"comp", OPTION_INPUT, offsetof(struct options, correction.comp), "FILE",
     "convert LinuxCNC's COMP_FILE of --axis, mm or degrees, instead of measuring"},
    {"comp-type", OPTION_WHOLE, offsetof(struct options, correction.comp_type), "0|1",
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
