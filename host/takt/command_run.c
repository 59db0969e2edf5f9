/* takt run: run the firmware on a part program against the virtual machine. */
#include "cli/interrupt.h"
#include "cli/message.h"
#include "cli/progress.h"
#include "cli/stopwatch.h"
#include "compiled/compiled_verifier.h"
#include "results/run.h"
#include "results/run_outputs.h"
#include "simulation/drives_table.h"
#include "simulation/error_map.h"
#include "takt/command.h"

#include <stdlib.h>

/* Cycles between two looks at failed writes and the progress bar. */
#define RUN_LOOK_CYCLES 1024

struct run_command {
    struct run run;
    struct run_outputs outputs;
    struct progress progress;
    bool has_told_drives; /* what they do without */
};

static void keep_cycle(void *context, const struct cycle_record *record, const struct block *block)
{
    struct run_command *c = context;

    run_outputs_add(&c->outputs, record, block);
}

/*
 * Writing is not the run's time. A report is written at its end: to keep a cycle for it takes no
 * longer than to look at the clock.
 */
static void write_cycle(void *context, const struct cycle_record *record, const struct block *block)
{
    struct run_command *c = context;
    uint64_t start_ns = stopwatch_now_ns();

    keep_cycle(context, record, block);
    c->run.wall_ns -= stopwatch_now_ns() - start_ns;
}

static struct run_watcher watcher_of(struct run_command *c)
{
    const bool writes = c->outputs.trace != NULL || c->outputs.bus_log != NULL;

    return (struct run_watcher){writes ? write_cycle : keep_cycle, c};
}

static void show_progress(struct run_command *c)
{
    const struct verifier_figures *figures = &c->run.verifier.figures;
    double motions = c->run.totals.last > 0 ? (double)c->run.totals.last : 1;

    progress_show(&c->progress, (double)figures->blocks / motions,
                  (double)figures->cycles * 1e-6 * (double)c->run.session.setup.machine.cycle_us);
}

static bool is_bus_lost(const struct run *run)
{
    return drive_network_get_problem(&run->simulation->network) != NULL;
}

/*
 * Drives on a bus outside are others' drives: what they do without is told before they have done
 * it, not after.
 */
static void tell_drives(struct run_command *c)
{
    const struct drives *drives = takt_controller_get_drives(&c->run.simulation->controller);

    c->has_told_drives = !c->run.simulation->network.is_outside ||
                         drives_table_tell(drives, c->run.session.options->quiet);
}

/* False: a file cannot be written. */
static bool look(struct run_command *c)
{
    if (c->run.simulation->cycles % RUN_LOOK_CYCLES != 0)
        return true;
    show_progress(c);
    return !run_outputs_failed(&c->outputs);
}

/*
 * Runs to the program's end, a fault, --until or a signal. False: a file cannot be written, or the
 * bus is gone.
 */
static bool run_loop(struct run_command *c)
{
    uint64_t start_ns = stopwatch_now_ns();
    bool good = true;

    while (!run_is_over(&c->run) && good && !interrupt_asked()) {
        good = run_cycle(&c->run);
        if (!c->has_told_drives)
            tell_drives(c);
        good = good && look(c);
    }
    c->run.wall_ns += stopwatch_now_ns() - start_ns;
    progress_end(&c->progress);
    return good;
}

/* A fault is about a line of the program, or about the machine. */
static void report_fault(const struct run *run)
{
    if (run->fault.line > 0)
        message_program_error(&run->session.program, &run->fault);
    else
        message_command_error("%s", run->summary.fault);
}

/* What the report shows beside the cycles. */
static void set_report(struct run_command *c)
{
    const struct run *run = &c->run;

    if (run->session.options->report == NULL)
        return;
    run_outputs_set_map(&c->outputs, error_map_json(&run->session, run->simulation));
    if (run->session.compiled != NULL)
        run_outputs_set_shares(&c->outputs,
                               compiled_shares_json(&run->session, run->compiled.stream));
}

static enum command_status finish(struct run_command *c, enum command_status cut)
{
    FILE *stream = run_outputs_use_stdout(&c->outputs) ? stderr : stdout;
    struct run *run = &c->run;

    run_finish(run, cut);
    run->session.parameters.values = run->simulation->parameters;
    if (run->summary.outcome != OUTCOME_COMPLETED)
        run_outputs_drop(&c->outputs,
                         RUN_PARAMETERS); /* the program is read ahead of what has been done */
    set_report(c);
    if (!announcer_finish(&run->simulation->announcer) ||
        !run_outputs_commit(&c->outputs, &run->summary, &run->session.parameters))
        return STATUS_ENVIRONMENT;
    if (run->summary.outcome == OUTCOME_FAULTED)
        report_fault(run);
    if (is_bus_lost(run))
        message_command_error("%s", drive_network_get_problem(&run->simulation->network));
    if (!run->session.options->quiet) {
        summary_write_text(stream, &run->summary);
        run_outputs_list(&c->outputs, stream);
    }
    return summary_status(&run->summary);
}

/* What nothing can be kept for. */
static enum command_status tell_why(struct run_command *c)
{
    const struct run *run = &c->run;

    if (run->verifier.tube.path.failed)
        message_command_error("out of memory");
    else if (run->simulation->target.problem[0] != '\0')
        message_command_error("--target: %s", run->simulation->target.problem);
    else if (!run_outputs_tell_failed(&c->outputs))
        message_command_error("the output files cannot be written");
    return STATUS_ENVIRONMENT;
}

static enum command_status cut_by_signal(const struct run *run)
{
    if (!interrupt_asked() ||
        takt_controller_get_state(&run->simulation->controller) >= CONTROLLER_COMPLETED)
        return STATUS_DONE;
    return (enum command_status)interrupt_status();
}

static enum command_status simulate(struct run_command *c)
{
    struct run *run = &c->run;
    enum command_status cut;

    if (!run_outputs_open(&c->outputs, &run->session, run->simulation))
        return STATUS_ENVIRONMENT;
    if (c->outputs.each_cycle)
        run->watcher = watcher_of(c);
    progress_start(&c->progress, !run->session.options->quiet);
    cut = run_loop(c) ? cut_by_signal(run) : STATUS_ENVIRONMENT;
    if (cut != STATUS_ENVIRONMENT || is_bus_lost(run))
        return finish(c, cut);
    run->cut = cut;
    run_end_drives(run);
    return tell_why(c);
}

static enum command_status execute(struct run_command *c, const struct options *options)
{
    enum command_status status = run_open(&c->run, options);

    if (status == STATUS_DONE && !run_outputs_plan(&c->outputs, &c->run.session))
        status = STATUS_INPUT;
    if (status == STATUS_DONE)
        status = run_prepare(&c->run);
    if (status == STATUS_DONE)
        status = simulate(c);
    run_outputs_close(&c->outputs);
    run_close(&c->run);
    return status;
}

static enum command_status command_run_execute(const struct options *options)
{
    struct run_command *c = calloc(1, sizeof *c);
    enum command_status status;

    if (c == NULL) {
        message_command_error("out of memory");
        return STATUS_ENVIRONMENT;
    }
    status = execute(c, options);
    free(c);
    return status;
}

static const struct option_row rows[] = {
    OPTIONS_PROGRAM,
    OPTIONS_DRIVEN,
    {"save-parameters", OPTION_FLAG, offsetof(struct options, save_parameters), NULL,
     "write the parameters back at the end"},
    {"until", OPTION_POSITIVE, offsetof(struct options, until_s), "SECONDS",
     "stop at this time of the program"},
    {"bus", OPTION_TEXT, offsetof(struct options, bus), "BUS",
     "embedded (default), socketcan:IF, slcan:PATH, socketcand:HOST:PORT; of two buses both, with "
     "a comma"},
    {"drives", OPTION_TEXT, offsetof(struct options, drives), "WHERE",
     "internal on the embedded bus, external on any other; m4f, m7: each an image in QEMU"},
    {"drive-image", OPTION_INPUT, offsetof(struct options, drive_image), "FILE",
     "its image, takt-drive.elf; host/run --drives builds it"},
    {"realtime", OPTION_FLAG, offsetof(struct options, realtime), NULL,
     "paced by the clock instead of as fast as possible"},
    {"plan", OPTION_INPUT, offsetof(struct options, plan), "HOW",
     "board (default): while it runs; ahead: compiled first; or a FILE of takt compile"},
    {"target", OPTION_TEXT, offsetof(struct options, target), "NAME",
     "run the controller in QEMU, on a Cortex-M4 (m4f), M7 (m7) or RISC-V (rv64), compared bit for "
     "bit"},
    {"image", OPTION_INPUT, offsetof(struct options, image), "FILE",
     "its image, takt-desk.elf; host/run --target builds it"},
    {"trace", OPTION_TEXT, offsetof(struct options, trace), "FILE.csv",
     "one row per control cycle"},
    {"rests", OPTION_TEXT, offsetof(struct options, rests), "FILE.csv",
     "tool point at every standstill of 50 ms and more, on a machine with errors"},
    {"inject", OPTION_INPUT, offsetof(struct options, inject), "FILE",
     "scripted faults of bus and drives; takt help inject explains them"},
    {"probe", OPTION_INPUT, offsetof(struct options, probe), "FILE",
     "what the probe touches, and inputs over time: box, ball, input; see host/probe"},
    {"stock", OPTION_INPUT, offsetof(struct options, stock), "FILE",
     "top of the material over X and Y: the depth of each cut, for the spindle's load; see "
     "host/spindle"},
    {"override", OPTION_INPUT, offsetof(struct options, override), "FILE",
     "feed override over time: lines of seconds and percent, 0 ... 120"},
    {"rapid-override", OPTION_INPUT, offsetof(struct options, rapid_override), "FILE",
     "rapid override over time, 0 ... 100"},
    {"override-method", OPTION_TEXT, offsetof(struct options, override_method), "METHOD",
     "adaptive (default) or proportional: see firmware/motion"},
    {"bus-log", OPTION_TEXT, offsetof(struct options, bus_log), "FILE",
     "every CAN frame, as candump -L writes it"},
    {"pulse-log", OPTION_TEXT, offsetof(struct options, pulse_log), "FILE",
     "every pulse of step drives: FILE.vcd for viewers of logic analysers, FILE.csv"},
    {"report", OPTION_TEXT, offsetof(struct options, report), "FILE.html",
     "path, feed and limits as pictures"},
    {"json", OPTION_TEXT, offsetof(struct options, json), "FILE", "the summary as JSON"},
    {"junit", OPTION_TEXT, offsetof(struct options, junit), "FILE",
     "the checks for CI servers, one case each"},
    {"quiet", OPTION_FLAG, offsetof(struct options, quiet), NULL, "no summary, no progress bar"},
    OPTIONS_END,
};

const struct command command_run = {
    .name = "run",
    .usage = "PROGRAM [options]",
    .summary = "run the firmware on a part program against the virtual machine",
    .help =
        "PROGRAM and every FILE may be - for standard input or output. The whole program is "
        "checked before anything\n"
        "moves. Output files appear at the end, complete, or not at all.\n"
        "\n"
        "Whatever ends a run ends it in order: the axes come to rest on the path, then the "
        "drives brake and go off\n"
        "(drives_stay_on of [bus]: stay switched on). So does Ctrl-C; the files then show the "
        "run up to that rest.\n"
        "A second Ctrl-C leaves the path and brakes at once.\n"
        "\n"
        "Exit status: 0 every check held; 1 a check failed or a drive faulted; 2 error in the "
        "program, a file or an\n"
        "option; 3 a file cannot be written, or the bus is lost; 4 every check held, but --until "
        "was reached before\n"
        "the program's end; 130 interrupted by Ctrl-C, 143 by SIGTERM, 129 by SIGHUP.\n"
        "\n"
        "Examples:\n"
        "  takt run part.ngc --report part.html\n"
        "  takt run part.ngc --machine mill3.ini --trace part.csv --json -\n"
        "  takt run part.ngc --plan part.plan          (of takt compile; with --target as "
        "well)\n"
        "  takt run part.ngc --set axis.X.max_jerk_mm_s3=20000 --until 2.5\n",
    .options = rows,
    .operands_min = 1,
    .operands_max = 1,
    .run = command_run_execute,
};
