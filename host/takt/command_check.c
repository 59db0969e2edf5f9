/* takt check: find all errors of a part program without moving anything. */
#include "cli/message.h"
#include "session/session.h"
#include "takt/command.h"

#include <stdio.h>

/*
 * Errors that are printed before the rest is given up: after this many the file is hardly a part
 * program.
 */
#define CHECK_ERRORS_MAX 100

static void print_found(const struct session *session, const struct session_totals *found)
{
    (void)printf("%s: no errors, %u warning%s; %u moves, %.3f mm\n", session->program.name,
                 found->warnings, found->warnings == 1 ? "" : "s", (unsigned)found->curves,
                 found->length_mm);
}

static enum command_status command_check_execute(const struct options *options)
{
    static struct session session;
    struct session_totals totals;
    const unsigned before = message_count_warnings();
    enum command_status status = session_open(&session, options);
    const unsigned of_opening = message_count_warnings() - before;

    if (status == STATUS_DONE) {
        status = session_check(&session, CHECK_ERRORS_MAX, &totals);
        if (status == STATUS_INPUT)
            (void)fprintf(stderr, "%s: %u error%s%s\n", session.program.name, totals.errors,
                          totals.errors == 1 ? "" : "s",
                          totals.errors == CHECK_ERRORS_MAX ? "; the rest was not read" : "");
        totals.warnings += of_opening;
    }
    if (status == STATUS_DONE && !options->quiet)
        print_found(&session, &totals);
    session_close(&session);
    return status;
}

static const struct option_row rows[] = {
    OPTIONS_PROGRAM,
    {"quiet", OPTION_FLAG, offsetof(struct options, quiet), NULL, "errors and warnings alone"},
    OPTIONS_END,
};

const struct command command_check = {
    .name = "check",
    .usage = "PROGRAM [options]",
    .summary = "find all errors of a part program without moving anything",
    .help = "Reads the whole program and continues after errors; a line with an error has no "
            "effect on later lines. For a\n"
            "program without errors the length of the path is printed; takt plan shows its time. "
            "Exit status 2 when there\n"
            "is an error.\n"
            "\n"
            "Examples:\n"
            "  takt check part.ngc\n"
            "  takt check part.ngc --machine mill3.ini --tools tools.tbl\n",
    .options = rows,
    .operands_min = 1,
    .operands_max = 1,
    .run = command_check_execute,
};
