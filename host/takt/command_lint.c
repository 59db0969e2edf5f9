/* takt lint: find what is right and yet hardly meant. */
#include "editor/lint.h"
#include "session/session.h"
#include "takt/command.h"

#include <stdio.h>

static enum command_status look(const struct options *options, double top_mm)
{
    static struct session session;
    struct session_totals totals;
    unsigned findings = 0;
    enum command_status status = session_open(&session, options);

    if (status == STATUS_DONE)
        status = session_check(&session, 1, &totals);
    if (status == STATUS_DONE)
        status = lint_program(&session, top_mm, &findings);
    if (status == STATUS_DONE && (findings > 0 || !options->quiet))
        (void)printf("%s: %u finding%s\n", session.program.name, findings,
                     findings == 1 ? "" : "s");
    session_close(&session);
    return status == STATUS_DONE && findings > 0 ? STATUS_FAILED : status;
}

static enum command_status command_lint_execute(const struct options *options)
{
    double top_mm;

    return lint_read_top(options->stock_top, &top_mm) ? look(options, top_mm) : STATUS_INPUT;
}

static const struct option_row rows[] = {
    OPTIONS_PROGRAM,
    {"stock-top", OPTION_TEXT, offsetof(struct options, stock_top), "Z",
     "top of the stock in work coordinates, mm (default 0)"},
    {"quiet", OPTION_FLAG, offsetof(struct options, quiet), NULL, "no summary without findings"},
    OPTIONS_END,
};

const struct command command_lint = {
    .name = "lint",
    .usage = "PROGRAM [options]",
    .summary = "find what is right and yet hardly meant",
    .help =
        "For a program without errors: rapids below the top of the stock, sideways or down (not "
        "into "
        "a hole that has been\n"
        "cut); feed while the spindle stands; cutter compensation of a tool without a radius; "
        "tools "
        "that the table does\n"
        "not have; lines that are never reached; feeds that no move with them ever reaches on this "
        "machine, and why.\n"
        "Probes and inputs answer nothing. Exit status 1 when something is found, 2 when there is "
        "an "
        "error.\n"
        "\n"
        "Examples:\n"
        "  takt lint part.ngc --tools tools.tbl\n"
        "  takt lint part.ngc --stock-top 12.5\n",
    .options = rows,
    .operands_min = 1,
    .operands_max = 1,
    .run = command_lint_execute,
};
