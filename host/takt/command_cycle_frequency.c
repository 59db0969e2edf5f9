/* takt cycle-frequency: control frequency needed for a machine's limits and an accuracy. */
#define _POSIX_C_SOURCE 200809L

#include "cli/message.h"
#include "cli/output_file.h"
#include "cli/suggest.h"
#include "config/machine_file.h"
#include "takt/command.h"

#include "base/maths.h"
#include "frequency/figures.h"
#include "frequency/machines.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Files: the diagrams, then the page. */
#define FILES (FREQUENCY_DIAGRAMS + 1)

struct frequency_job {
    struct frequency_question question;
    struct cycle_need need;
    struct machine_setup setup;
    struct output_file file[FILES];
};

/*
 * A number above 0 with an optional suffix: NULL text leaves *number alone. False after a message.
 */
static bool read_positive(const char *option, const char *text, const char *suffix, double ratio,
                          double *number)
{
    char *end;
    double value;

    if (text == NULL)
        return true;
    value = strtod(text, &end);
    if (end != text && suffix != NULL && strcmp(end, suffix) == 0) {
        value *= ratio;
        end += strlen(end);
    }
    if (end == text || *end != '\0' || !isfinite(value)) {
        message_command_error("--%s %s: a number is expected%s%s", option, text,
                              suffix != NULL ? ", or one followed by " : "",
                              suffix != NULL ? suffix : "");
        return false;
    }
    if (value <= 0) {
        message_command_error("--%s %s: it must be above 0", option, text);
        return false;
    }
    *number = value;
    return true;
}

/* The plane of two linear axes that needs the highest frequency stands for the machine. */
static bool use_machine_file(struct frequency_job *job, const struct options *options)
{
    struct cycle_need need;

    if (!machine_file_load(&job->setup, options))
        return false;
    takt_controller_cycle_need(&job->setup.machine, &need, &job->question.limits);
    if (need.frequency_hz <= 0) {
        message_command_error("the machine has no two linear axes: no circles, no chord error");
        return false;
    }
    job->question.machine = job->setup.machine.name;
    job->question.resolution_per_mm = job->setup.machine.resolution_per_mm;
    job->question.frequency_hz = 1e6 / (double)job->setup.machine.cycle_us;
    return true;
}

static void report_unknown_machine(const char *name)
{
    const char *names[16];

    for (size_t i = 0; i < known_machines_count; i++)
        names[i] = known_machines[i].name;
    message_command_error(
        "--machine %s: neither a file nor a machine of the list in --help%s", name,
        message_did_you_mean("", suggest_word(name, names, (unsigned)known_machines_count)));
}

static bool is_limited_by_hand(const struct option_frequency *given)
{
    return given->feed_max != NULL || given->acceleration != NULL || given->jerk != NULL;
}

/* A machine whose limits nobody has published is what it is said to be. */
static bool takes_given_limits(const struct known_machine *known,
                               const struct option_frequency *given)
{
    if (given->feed_max != NULL && given->acceleration != NULL && given->jerk != NULL)
        return true;
    message_command_error(
        "--machine %s: its limits are not published, only that jerk governs on X at every radius "
        "and on Z up to 3 mm: give --feed-max, --accel and --jerk",
        known->name);
    return false;
}

static bool use_machine(struct frequency_job *job, const struct options *options)
{
    const struct known_machine *known =
        options->machine != NULL ? known_machine_find(options->machine) : NULL;

    job->question.resolution_per_mm = 1000;
    if (known != NULL) {
        job->question.machine = known->name;
        if (!known_machine_has_limits(known))
            return takes_given_limits(known, &options->frequency);
        job->question.limits = known_machine_limits(known);
        return true;
    }
    if (options->machine == NULL && is_limited_by_hand(&options->frequency)) {
        job->question.machine = "a machine of these limits";
        job->question.limits =
            (struct cycle_limits){MATHS_INFINITY, MATHS_INFINITY, MATHS_INFINITY};
        return true;
    }
    if (options->machine != NULL && access(options->machine, F_OK) != 0) {
        report_unknown_machine(options->machine);
        return false;
    }
    return use_machine_file(job, options);
}

static bool read_question(struct frequency_job *job, const struct options *options)
{
    const struct option_frequency *given = &options->frequency;
    struct frequency_question *q = &job->question;
    double feed = 60 * q->limits.feed_mm_s, jerk = q->limits.jerk_mm_s3 / 1000;

    if (!read_positive("feed-max", given->feed_max, NULL, 1, &feed) ||
        !read_positive("accel", given->acceleration, "g", STANDARD_GRAVITY_MM_S2,
                       &q->limits.acceleration_mm_s2) ||
        !read_positive("jerk", given->jerk, NULL, 1, &jerk) ||
        !read_positive("resolution", given->resolution, NULL, 1, &q->resolution_per_mm) ||
        !read_positive("frequency", given->frequency, NULL, 1, &q->frequency_hz))
        return false;
    q->limits.feed_mm_s = feed / 60;
    q->limits.jerk_mm_s3 = jerk * 1000;
    q->tolerance_mm = 1 / q->resolution_per_mm;
    if (!read_positive("tolerance", given->tolerance, NULL, 1, &q->tolerance_mm))
        return false;
    if (isfinite(q->limits.feed_mm_s) || isfinite(q->limits.acceleration_mm_s2))
        return true;
    message_command_error("--jerk alone: larger circles need ever higher frequencies; give "
                          "--feed-max or --accel too");
    return false;
}

static bool open_files(struct frequency_job *job, const struct option_frequency *given)
{
    for (unsigned i = 0; i < FREQUENCY_DIAGRAMS && given->svg != NULL; i++) {
        char path[OUTPUT_PATH_MAX];
        int length = snprintf(path, sizeof path, "%s-%s.svg", given->svg,
                              frequency_diagram_name((enum frequency_diagram)i));

        if (length >= (int)sizeof path) {
            message_command_error("--svg: the path is too long");
            return false;
        }
        if (!output_file_open(&job->file[i], path))
            return false;
        frequency_diagram_write(job->file[i].stream, &job->question, (enum frequency_diagram)i);
    }
    if (given->html == NULL)
        return true;
    if (!output_file_open(&job->file[FREQUENCY_DIAGRAMS], given->html))
        return false;
    frequency_page_write(job->file[FREQUENCY_DIAGRAMS].stream, &job->question, &job->need);
    return true;
}

static enum command_status write_files(struct frequency_job *job,
                                       const struct option_frequency *given)
{
    bool good = open_files(job, given);

    for (unsigned i = 0; i < FILES && good; i++)
        good = job->file[i].stream == NULL || output_file_finish(&job->file[i]);
    for (unsigned i = 0; i < FILES && good; i++)
        good = job->file[i].path[0] == '\0' || output_file_place(&job->file[i]);
    for (unsigned i = 0; i < FILES; i++)
        output_file_discard(&job->file[i]);
    return good ? STATUS_DONE : STATUS_ENVIRONMENT;
}

static enum command_status answer(struct frequency_job *job, const struct options *options)
{
    if (!use_machine(job, options) || !read_question(job, options))
        return STATUS_INPUT;
    takt_cycle_frequency_find(&job->question.limits, job->question.tolerance_mm, &job->need);
    if (!options->quiet) {
        frequency_print_question(&job->question);
        frequency_print_need(&job->question, &job->need);
        if (options->frequency.radius_table)
            frequency_print_table(&job->question, &job->need);
    }
    return write_files(job, &options->frequency);
}

static enum command_status command_cycle_frequency_execute(const struct options *options)
{
    struct frequency_job *job = calloc(1, sizeof *job);
    enum command_status status;

    if (job == NULL) {
        message_command_error("out of memory");
        return STATUS_ENVIRONMENT;
    }
    status = answer(job, options);
    free(job);
    return status;
}

static const struct option_row rows[] = {
    {"machine", OPTION_INPUT, offsetof(struct options, machine), "NAME|FILE",
     "6R13GN1, FP7M, FP7SMN, MA655SM30A, MA655 X, 16K20F3, UCP710, or a machine file (default: the "
     "built-in "
     "mill)"},
    {"set", OPTION_LIST, offsetof(struct options, set), "KEY=VALUE",
     "override a key of the machine file"},
    {"feed-max", OPTION_TEXT, offsetof(struct options, frequency.feed_max), "MM_MIN",
     "highest feed, mm/min"},
    {"accel", OPTION_TEXT, offsetof(struct options, frequency.acceleration), "A",
     "acceleration, mm/s2, or in g: 0.1g"},
    {"jerk", OPTION_TEXT, offsetof(struct options, frequency.jerk), "M_S3", "jerk, m/s3"},
    {"resolution", OPTION_TEXT, offsetof(struct options, frequency.resolution), "PER_MM",
     "increments per mm (default 1000, or the machine file's)"},
    {"tolerance", OPTION_TEXT, offsetof(struct options, frequency.tolerance), "MM",
     "chord error, mm (default: one increment)"},
    {"frequency", OPTION_TEXT, offsetof(struct options, frequency.frequency), "HZ",
     "of the controller (default: the machine file's cycle)"},
    {"radius-table", OPTION_FLAG, offsetof(struct options, frequency.radius_table), NULL,
     "a table over radii too"},
    {"svg", OPTION_TEXT, offsetof(struct options, frequency.svg), "PREFIX",
     "the diagrams: PREFIX-chord-error.svg, -allowed-feed.svg, -needed-frequency.svg"},
    {"html", OPTION_TEXT, offsetof(struct options, frequency.html), "FILE",
     "all diagrams on one page"},
    {"quiet", OPTION_FLAG, offsetof(struct options, quiet), NULL, "files alone"},
    OPTIONS_END,
};

const struct command command_cycle_frequency = {
    .name = "cycle-frequency",
    .usage = "[options]",
    .summary = "control frequency needed for a machine's limits and an accuracy",
    .help = "A controller moves straight between the points of two cycles. This is the lowest "
            "frequency at which no circle\n"
            "that the machine can drive, as fast as feed, acceleration and jerk let it, is left by "
            "more than the tolerance.\n"
            "Limits that are given replace the machine's; without a machine, those not given do "
            "not limit. UCP710 has no published limits: give all three.\n"
            "\n"
            "Examples:\n"
            "  takt cycle-frequency --machine MA655SM30A --radius-table\n"
            "  takt cycle-frequency --accel 0.1g --jerk 5\n"
            "  takt cycle-frequency --machine mill.ini --html frequency.html\n",
    .options = rows,
    .operands_min = 0,
    .operands_max = 0,
    .run = command_cycle_frequency_execute,
};
