/* takt correct: write a program with position errors corrected, for other controllers. */
#include "cli/message.h"
#include "cli/output_file.h"
#include "config/correction_file.h"
#include "correct/offline.h"
#include "takt/command.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* Unless --tolerance says something else. */
#define TOLERANCE_MM 0.0005

/* Words have six decimals: less cannot be kept. */
#define TOLERANCE_MIN_MM 0.00001

/* The table of --table takes the place of the machine file's of its kind. */
static bool use_table(struct session *session, const char *path)
{
    struct machine_setup *setup = &session->setup;
    struct table *table = malloc(sizeof *table);
    char *place = setup->volume_table;
    bool good = table != NULL && correction_file_read(table, path, &setup->machine);

    if (good && table->inputs == 1)
        place =
            table->errors ? setup->unit_table[table->input[0]] : setup->axis_table[table->input[0]];
    free(table);
    if (!good)
        return false;
    if (strlen(path) > MACHINE_SETUP_PATH_MAX) {
        message_command_error("--table: the path is too long");
        return false;
    }
    (void)snprintf(place, MACHINE_SETUP_PATH_MAX + 1, "%s", path);
    free(session->correction);
    session->correction = NULL;
    return correction_file_load(&session->correction, setup);
}

static void print_warnings(const char *name, double tolerance_mm, bool has_tables,
                           const struct offline_totals *totals)
{
    if (!has_tables && totals->motions > 0 && !(totals->largest_mm > 0))
        message_warning(name, 0, 0,
                        "nothing is corrected: name a table by --table, or what corrects in "
                        "[correction] of the machine file");
    if (totals->compensated)
        message_warning(name, 0, 0,
                        "contours with G41 or G42 are corrected as programmed, not where the "
                        "tool's centre goes");
    if (totals->thread_error_mm > tolerance_mm)
        message_warning(name, totals->thread_line, 0,
                        "threads are not divided: this one is within %.6f mm of the corrected path",
                        totals->thread_error_mm);
    if (totals->input_line > 0)
        message_warning(name, totals->input_line, 0,
                        "what M66 reads is not known before it is run, and taken for 0 here");
}

static void print_totals(const struct options *options, const struct offline_config *config,
                         const struct offline_totals *totals)
{
    print_warnings(config->name, config->tolerance_mm, config->session->correction != NULL, totals);
    if (options->quiet)
        return;
    (void)fprintf(stderr,
                  "%u motions in %u pieces; corrected by %.4f mm at most; the written path is "
                  "within %.6f mm of the corrected one\n",
                  (unsigned)totals->motions, (unsigned)totals->pieces, totals->largest_mm,
                  totals->error_mm);
}

static enum command_status correct_text(struct offline_config *config,
                                        const struct options *options,
                                        struct offline_totals *totals)
{
    enum command_status status = STATUS_INPUT;
    struct text text;

    if (!text_read(&text, options->operand[0]))
        return STATUS_INPUT;
    config->text = text.bytes;
    config->length = text.length;
    config->name = text.name;
    status = offline_correct(config, totals);
    text_free(&text);
    return status;
}

static bool read_tolerance(const char *text, double *tolerance_mm)
{
    char *end;

    *tolerance_mm = TOLERANCE_MM;
    if (text == NULL)
        return true;
    *tolerance_mm = strtod(text, &end);
    if (end != text && *end == '\0' && *tolerance_mm >= TOLERANCE_MIN_MM &&
        *tolerance_mm <= DBL_MAX)
        return true;
    message_command_error("--tolerance '%s' must be a number of mm, at least %g", text,
                          TOLERANCE_MIN_MM);
    return false;
}

static enum command_status correct(struct session *session, const struct options *options)
{
    struct offline_config config = {
        .session = session,
        .stream = stdin,
        .name = "<stdin>",
    };
    struct offline_totals totals = {0};
    struct output_file file;
    enum command_status status;

    if (!read_tolerance(options->correction.tolerance, &config.tolerance_mm))
        return STATUS_INPUT;
    if (options->correction.filter && strcmp(options->operand[0], "-") != 0) {
        message_command_error("--filter reads standard input: the program is -");
        return STATUS_INPUT;
    }
    if (!output_file_replace(&file, options->output != NULL ? options->output : "-",
                             options->operand[0]))
        return STATUS_ENVIRONMENT;
    config.out = file.stream;
    status = options->correction.filter ? offline_correct(&config, &totals)
                                        : correct_text(&config, options, &totals);
    if (status != STATUS_DONE) {
        output_file_discard(&file);
        return status;
    }
    if (!output_file_finish(&file) || !output_file_place(&file))
        return STATUS_ENVIRONMENT;
    print_totals(options, &config, &totals);
    return STATUS_DONE;
}

static enum command_status command_correct_execute(const struct options *options)
{
    static struct session session;
    enum command_status status = session_open_machine(&session, options);

    if (status == STATUS_DONE && options->correction.table != NULL &&
        !use_table(&session, options->correction.table))
        status = STATUS_INPUT;
    if (status == STATUS_DONE)
        status = correct(&session, options);
    session_close(&session);
    return status;
}

static const struct option_row rows[] = {
    OPTIONS_PROGRAM,
    {"table", OPTION_INPUT, offsetof(struct options, correction.table), "FILE",
     "correction table, CSV; in the place of the machine file's of its kind, beside all others"},
    {"tolerance", OPTION_TEXT, offsetof(struct options, correction.tolerance), "MM",
     "distance of the written path from the corrected one (0.0005)"},
    {"filter", OPTION_FLAG, offsetof(struct options, correction.filter), NULL,
     "line by line from standard input to standard output, as a program is streamed"},
    {"output", OPTION_TEXT, offsetof(struct options, output), "FILE",
     "or -o FILE: the corrected program (default: standard output)"},
    {"quiet", OPTION_FLAG, offsetof(struct options, quiet), NULL, "errors and warnings alone"},
    OPTIONS_END,
};

const struct command command_correct = {
    .name = "correct",
    .usage = "PROGRAM [--table FILE] [options]",
    .summary = "write a program with position errors corrected, for other controllers",
    .help = "The words of every motion are replaced by corrected ones. A long line in a curved "
            "field of errors, an arc or\n"
            "an involute becomes several. Comments, feeds, modes, line numbers and subroutines "
            "stay; a line in a loop or\n"
            "a subroutine gets a form for each time it runs. Rapids are corrected at their ends. "
            "Cycles are written out\n"
            "as lines, G76 as threads. Threads are not divided; their pitch grows with their "
            "length. In G28 and G30 the\n"
            "intermediate point is corrected; the reference belongs to the machine. G92 and G10 "
            "L20 set the same offsets\n"
            "as without correction. Probing is refused, since its end is not known. Where a "
            "program has left the\n"
            "corrected path, by G28 or by switching layers (M120, M121), the first piece of the "
            "next motion returns to\n"
            "it.\n"
            "\n"
            "Layers of [correction] that depend on position take part: matrix, set-up, axes (both "
            "directions' mean),\n"
            "volume. --filter reads and writes line by line; loops and calls are then errors, "
            "since a stream cannot go\n"
            "back.\n"
            "\n"
            "Examples:\n"
            "  takt correct part.ngc --machine mill.ini --table volume.csv -o part-corrected.ngc\n"
            "  sender part.ngc | takt correct - --filter --table volume.csv | machine\n",
    .options = rows,
    .operands_min = 1,
    .operands_max = 1,
    .run = command_correct_execute,
};
