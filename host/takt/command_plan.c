#include "takt/command.h"
#include "takt/message.h"
#include "takt/output_file.h"
#include "takt/planner.h"
#include "takt/session.h"

#include "base/maths.h"

#include <cjson/cJSON.h>
#include <stdlib.h>

struct plan_print {
    FILE *table; /* NULL: no table */
    FILE *json;  /* NULL: no JSON */
    double cycle_s;
    bool any; /* a block has been written: JSON needs a comma */
};

static const char *kind_name(enum move_kind kind)
{
    static const char *const names[] = {
        "rapid", "feed",    "arc_cw", "arc_ccw", "involute_cw", "involute_ccw", "thread",
        "tap",   "tap_out", "probe",  "dwell",   "spindle",     "orient",       "coolant",
        "tool",  "output",  "input",  "stop",    "end"};

    return names[kind];
}

static const char *governor_name(enum governor governor)
{
    static const char *const names[] = {"program", "velocity", "acceleration", "jerk",
                                        "chord",   "smooth",   "short",        "ramp"};

    return names[governor];
}

static const char *end_name(enum joint_kind end)
{
    static const char *const names[] = {"passed", "reduced", "stop"};

    return names[end];
}

/* mm/s to mm/min; of a motion of rotary axes alone rad/s to deg/min. */
static double shown_feed(const struct block *block, double feed_mm_s)
{
    return feed_mm_s * 60.0 * (block->rotary ? 180.0 / MATHS_PI : 1.0);
}

static double shown_length(const struct block *block)
{
    return block->curve.length_mm * (block->rotary ? 180.0 / MATHS_PI : 1.0);
}

static const char *length_unit(const struct block *block)
{
    return block->rotary ? "deg" : "mm";
}

static void table_head(FILE *stream)
{
    (void)fprintf(stream, "%7s %7s  %-8s %14s %10s %10s %10s  %-8s %-13s %10s\n", "block", "line",
                  "kind", "length", "F start", "F cruise", "F end", "end", "governor", "time [s]");
}

static void table_row(const struct plan_print *print, const struct planned_block *planned)
{
    const struct block *block = planned->block;

    if (!move_is_motion(&block->move)) {
        (void)fprintf(print->table, "%7s %7u  %-8s %70s %10.6f\n", "-", (unsigned)block->move.line,
                      kind_name(block->move.kind), "", planned->time_s);
        return;
    }
    (void)fprintf(
        print->table, "%7u %7u  %-8s %10.6f %-3s %10.3f %10.3f %10.3f  %-8s %-13s %10.6f\n",
        (unsigned)block->number, (unsigned)block->move.line, kind_name(block->move.kind),
        shown_length(block), length_unit(block), shown_feed(block, planned->feed_start_mm_s),
        shown_feed(block, planned->feed_cruise_mm_s), shown_feed(block, planned->feed_end_mm_s),
        end_name(block->end), governor_name(planned->governor), planned->time_s);
}

static void json_feeds(FILE *stream, const struct planned_block *planned)
{
    const struct block *block = planned->block;
    const char *unit = length_unit(block);

    (void)fprintf(
        stream,
        ", \"length_%s\": %.17g, \"feed_start_%s_min\": %.17g, \"feed_cruise_%s_min\": %.17g, "
        "\"feed_end_%s_min\": %.17g, \"end\": \"%s\", \"governor\": \"%s\"",
        unit, shown_length(block), unit, shown_feed(block, planned->feed_start_mm_s), unit,
        shown_feed(block, planned->feed_cruise_mm_s), unit,
        shown_feed(block, planned->feed_end_mm_s), end_name(block->end),
        governor_name(planned->governor));
}

static void json_row(const struct plan_print *print, const struct planned_block *planned)
{
    const struct block *block = planned->block;
    bool motion = move_is_motion(&block->move);

    (void)fprintf(print->json, "%s\n    {\"block\": %u, \"line\": %u, \"kind\": \"%s\"",
                  print->any ? "," : "", (unsigned)block->number, (unsigned)block->move.line,
                  kind_name(block->move.kind));
    if (motion)
        json_feeds(print->json, planned);
    (void)fprintf(print->json, ", \"time_s\": %.17g}", planned->time_s);
}

static void print_block(void *context, const struct planned_block *planned)
{
    struct plan_print *print = context;

    if (print->table != NULL)
        table_row(print, planned);
    if (print->json != NULL)
        json_row(print, planned);
    print->any = true;
}

static void print_totals(const struct plan_print *print, const struct planner_totals *totals)
{
    double time_s = (double)totals->cycles * print->cycle_s;

    if (print->table != NULL)
        (void)fprintf(print->table, "%u moves, %.6f mm, %u stops, %.3f s\n",
                      (unsigned)totals->motions, totals->length_mm, (unsigned)totals->stops,
                      time_s);
    if (print->json != NULL)
        (void)fprintf(print->json,
                      "\n  ],\n  \"totals\": {\"moves\": %u, \"length_mm\": %.17g, \"stops\": %u, "
                      "\"cycles\": %llu, "
                      "\"time_s\": %.17g}\n}\n",
                      (unsigned)totals->motions, totals->length_mm, (unsigned)totals->stops,
                      (unsigned long long)totals->cycles, time_s);
}

static void print_heads(const struct plan_print *print, const struct session *session)
{
    cJSON *name = cJSON_CreateString(session->program.name);
    char *quoted = name != NULL ? cJSON_PrintUnformatted(name) : NULL;

    if (print->table != NULL)
        table_head(print->table);
    if (print->json != NULL)
        (void)fprintf(print->json, "{\n  \"program\": %s,\n  \"blocks\": [",
                      quoted != NULL ? quoted : "null");
    free(quoted);
    cJSON_Delete(name);
}

static enum command_status plan_into(const struct session *session, struct output_file *json)
{
    bool to_stdout = json->stream == stdout;
    struct plan_print print = {
        .table = to_stdout || session->options->quiet ? NULL : stdout,
        .json = json->stream,
        .cycle_s = 1e-6 * (double)session->setup.machine.cycle_us,
    };
    struct planner_totals totals;
    enum command_status status;

    print_heads(&print, session);
    status = planner_walk(session, print_block, &print, &totals);
    if (status != STATUS_DONE)
        return status;
    print_totals(&print, &totals);
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
        status = plan_into(&session, &json);
    output_file_discard(&json);
    session_close(&session);
    return status;
}

static const struct option_row rows[] = {
    OPTIONS_PROGRAM,
    {"json", OPTION_TEXT, offsetof(struct options, json), "FILE", "the same for programs"},
    {"quiet", OPTION_FLAG, offsetof(struct options, quiet), NULL, "no table"},
    OPTIONS_END,
};

const struct command command_plan = {
    .name = "plan",
    .usage = "PROGRAM [options]",
    .summary = "show the planned blocks: lengths, feeds, what governs them, times",
    .help = "One row a block: its length in mm (deg when only rotary axes move), the feed at its "
            "start, its highest\n"
            "feed and the feed at its end in mm/min, how it ends (passed at full feed, reduced for "
            "the joint, stop),\n"
            "the limit that governs its feed, and its time. An involute has a row for each piece "
            "of it.\n"
            "\n"
            "Examples:\n"
            "  takt plan part.ngc\n"
            "  takt plan part.ngc --set machine.look_ahead_blocks=16 --json plan.json --quiet\n",
    .options = rows,
    .operands_min = 1,
    .operands_max = 1,
    .run = command_plan_execute,
};
