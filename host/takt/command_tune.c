/* takt tune: gains of the drives' loops, by a test of their torque. */
#include "cli/axis_letters.h"
#include "cli/message.h"
#include "cli/output_file.h"
#include "findings/tune_findings.h"
#include "takt/command.h"

#include <stdlib.h>

enum { SECTIONS, DCF, JSON, REPORT, FILES };

static void (*const writers[FILES])(FILE *, const struct tune_test *) = {
    tune_findings_write_sections, tune_findings_write_dcf, tune_findings_write_json,
    tune_findings_write_report};

static enum command_status open_files(struct output_file file[FILES], const struct options *options)
{
    static const char *const option[FILES] = {"output", "dcf", "json", "report"};
    const char *const path[FILES] = {options->output, options->dcf, options->json, options->report};

    if (!output_file_differ(option, path, FILES))
        return STATUS_INPUT;
    for (unsigned i = 0; i < FILES; i++) {
        if (path[i] != NULL && !output_file_open(&file[i], path[i]))
            return STATUS_ENVIRONMENT;
    }
    return STATUS_DONE;
}

/* All of them or none. */
static bool write_files(struct output_file file[FILES], const struct tune_test *test)
{
    bool is_there[FILES];

    for (unsigned i = 0; i < FILES; i++) {
        is_there[i] = file[i].stream != NULL;
        if (is_there[i])
            writers[i](file[i].stream, test);
        if (is_there[i] && !output_file_finish(&file[i]))
            return false;
    }
    for (unsigned i = 0; i < FILES; i++) {
        if (is_there[i] && !output_file_place(&file[i]))
            return false;
    }
    return true;
}

static bool is_shown(const struct output_file file[FILES], const struct options *options)
{
    bool is_free = !options->quiet;

    for (unsigned i = 0; i < FILES; i++)
        is_free = is_free && file[i].stream != stdout;
    return is_free;
}

static enum command_status execute(struct tune_test *test, unsigned axes,
                                   const struct options *options)
{
    static struct output_file file[FILES];
    enum command_status status = open_files(file, options);

    if (status == STATUS_DONE)
        status = tune_test_run(test, axes, options);
    for (unsigned i = 0; i < AXIS_COUNT && is_shown(file, options); i++) {
        if (test->axis[i].is_measured)
            tune_findings_print_axis(&test->axis[i], i);
    }
    if (status == STATUS_DONE && !write_files(file, test))
        status = STATUS_ENVIRONMENT;
    for (unsigned i = 0; i < FILES; i++)
        output_file_discard(&file[i]);
    return status;
}

static enum command_status command_tune_execute(const struct options *options)
{
    struct tune_test *test = calloc(1, sizeof *test);
    enum command_status status = STATUS_INPUT;
    unsigned axes;

    if (test == NULL) {
        message_command_error("out of memory");
        return STATUS_ENVIRONMENT;
    }
    if (axis_letters_read(options->axes, &axes)) {
        if ((options->dcf != NULL || options->tune_record != NULL) &&
            (axes == 0 || (axes & (axes - 1)) != 0))
            message_command_error("--dcf and --record are of one drive: name its axis, as in "
                                  "--axes X");
        else
            status = execute(test, axes, options);
    }
    tune_test_free(test);
    free(test);
    return status;
}

static const struct option_row rows[] = {
    {"axes", OPTION_TEXT, offsetof(struct options, axes), "LETTERS",
     "XY, say (default: all on CAN)"},
    {"record", OPTION_INPUT, offsetof(struct options, tune_record), "FILE",
     "a test of a real drive in place of the virtual one's: rows of torque Nm and position, a row "
     "a cycle"},
    {"output", OPTION_TEXT, offsetof(struct options, output), "FILE",
     "or -o FILE: sections of the machine file"},
    {"dcf", OPTION_TEXT, offsetof(struct options, dcf), "FILE",
     "object 2020 of one drive as a concise configuration (CiA 302, 1F22)"},
    {"json", OPTION_TEXT, offsetof(struct options, json), "FILE", "the figures as JSON"},
    {"report", OPTION_TEXT, offsetof(struct options, report), "FILE",
     "test, step and following error as curves, HTML"},
    {"quiet", OPTION_FLAG, offsetof(struct options, quiet), NULL, "no figures"},
    OPTIONS_MACHINE,
    OPTIONS_END,
};

const struct command command_tune = {
    .name = "tune",
    .usage = "[options]",
    .summary = "find the gains of drives' loops on the virtual machine",
    .help =
        "Moves one axis after the other a little by a torque that turns to and fro (cyclic torque, "
        "mode 10; the drive's loops\n"
        "have no part in it), and finds what it moves: inertia, friction, weight, and how late the "
        "torque comes. For that the\n"
        "fastest gains that leave 60 degrees of phase margin in both loops and let a step of the "
        "target overshoot by 10 % at\n"
        "most. Tries what the drive has and what was found by a step and a move, and says both. "
        "Gains that are as good are\n"
        "left as they are.\n"
        "\n"
        "A real drive whose maker's tool records such a test is tuned by --record: a row has the "
        "torque that it got from there\n"
        "on and where its axis was, in mm or degrees, every cycle_us of the machine. The virtual "
        "drive then moves what it moved.\n"
        "\n"
        "Exit status: 0 done; 1 an axis cannot be tuned; 2 wrong input; 3 a file cannot be "
        "written.\n"
        "\n"
        "Examples:\n"
        "  takt tune --machine mill3.ini --report tune.html\n"
        "  takt tune --axes X --set drive.1.inertia_kg_m2=2e-3 -o tuned.ini\n"
        "  takt tune --axes X --record x.txt --dcf x.dcf\n",
    .options = rows,
    .operands_min = 0,
    .operands_max = 0,
    .run = command_tune_execute,
};
