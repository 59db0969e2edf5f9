/* takt plan: show the planned blocks: lengths, feeds, what governs them, times. */
#include "cli/output_file.h"
#include "session/plan_write.h"
#include "session/session.h"
#include "takt/command.h"

static enum command_status plan_into(const struct session *session,
                                     const struct session_totals *found, struct output_file *json)
{
    bool to_stdout = json->stream == stdout;
    FILE *table = to_stdout || session->options->quiet ? NULL : stdout;
    enum command_status status = plan_write(session, found, table, json->stream);

    if (status != STATUS_DONE)
        return status;
    if (json->stream != NULL && !(output_file_finish(json) && output_file_place(json)))
        return STATUS_ENVIRONMENT;
    return STATUS_DONE;
}

static enum command_status command_plan_execute(const struct options *options)
{
    static struct output_file json;
    static struct session session;
    struct session_totals totals;
    enum command_status status = session_open(&session, options);

    if (status == STATUS_DONE)
        status = session_check(&session, 1, &totals);
    if (status == STATUS_DONE && options->json != NULL && !output_file_open(&json, options->json))
        status = STATUS_ENVIRONMENT;
    if (status == STATUS_DONE)
        status = plan_into(&session, &totals, &json);
    output_file_discard(&json);
    session_close(&session);
    return status;
}

static const struct option_row rows[] = {
    OPTIONS_PROGRAM,
    {"json", OPTION_TEXT, offsetof(struct options, json), "FILE", "the same as JSON"},
    {"quiet", OPTION_FLAG, offsetof(struct options, quiet), NULL, "no table"},
    OPTIONS_END,
};

const struct command command_plan = {
    .name = "plan",
    .usage = "PROGRAM [options]",
    .summary = "show the planned blocks: lengths, feeds, what governs them, times",
    .help = "One row per block: its length in mm (deg when only rotary axes move); its feed at the "
            "start, its highest\n"
            "feed and its feed at the end in mm/min; how it ends (passed at full feed, reduced for "
            "the junction, stop); the\n"
            "limit that governs its feed; and its time. An involute has a row for each of its "
            "pieces. A smoothed path\n"
            "(G64 P) shows the number of its pieces and the governing limit of the longest one. "
            "Blocks that became one\n"
            "curve are shown as FIRST-LAST.\n"
            "\n"
            "Examples:\n"
            "  takt plan part.ngc\n"
            "  takt plan part.ngc --set machine.look_ahead_blocks=16 --json plan.json --quiet\n",
    .options = rows,
    .operands_min = 1,
    .operands_max = 1,
    .run = command_plan_execute,
};
