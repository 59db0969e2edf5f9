#include "takt/command.h"
#include "takt/interrupt.h"
#include "takt/judge.h"
#include "takt/message.h"
#include "takt/progress.h"
#include "takt/run_outputs.h"
#include "takt/session.h"
#include "takt/simulation.h"
#include "takt/stopwatch.h"
#include "takt/summary.h"

#include <stdlib.h>

/* Cycles between two looks at Ctrl-C, failed writes and the progress bar. */
#define RUN_LOOK_CYCLES 1024

struct run {
    struct session session;
    struct session_totals totals;
    struct session_reading reading; /* the judge's */
    struct judge judge;
    struct simulation *simulation;
    struct run_outputs outputs;
    struct progress progress;
    uint64_t until_cycles; /* program cycles after which to stop; UINT64_MAX: the program's end */
    uint64_t wall_ns;
};

static void prepare_judge(struct run *run)
{
    struct program_config config;
    struct source source;

    session_begin_reading(&run->session, &run->reading, &config, &source);
    judge_init(&run->judge, &run->session.setup.machine, &config, &source);
}

static void set_until(struct run *run)
{
    double cycle_s = 1e-6 * (double)run->session.setup.machine.cycle_us;
    double cycles = run->session.options->until_s / cycle_s;

    /* Half a cycle of room: 0.1 s are 100 cycles of 1 ms, whatever the division's last bit says. */
    run->until_cycles =
        run->session.options->until_s > 0 && cycles < 1e18 ? (uint64_t)(cycles + 0.5) : UINT64_MAX;
}

/* One cycle of the world and of everybody who watches it. */
static void run_cycle(struct run *run)
{
    const struct cycle_record *record;
    const struct segment *segment;

    simulation_step(run->simulation);
    record = controller_get_record(&run->simulation->controller);
    segment = controller_get_segment(&run->simulation->controller);
    if (record != NULL)
        judge_add(&run->judge, record, segment);
    if (run->outputs.each_cycle) {
        uint64_t start_ns = stopwatch_now_ns();

        run_outputs_add(&run->outputs, record, segment);
        run->wall_ns -= stopwatch_now_ns() - start_ns; /* writing is not the run's time */
    }
}

static void show_progress(struct run *run)
{
    const struct judge_figures *figures = &run->judge.figures;
    double motions = run->totals.last > 0 ? (double)run->totals.last : 1;

    progress_show(&run->progress, (double)figures->blocks / motions,
                  (double)figures->cycles * 1e-6 * (double)run->session.setup.machine.cycle_us);
}

/* Runs to the program's end, a fault or --until. False: interrupted, or a file cannot be written. */
static bool run_loop(struct run *run)
{
    const struct controller *controller = &run->simulation->controller;
    uint64_t start_ns = stopwatch_now_ns();
    bool good = true;

    while (controller_get_state(controller) < CONTROLLER_COMPLETED && good) {
        run_cycle(run);
        if (run->judge.figures.cycles >= run->until_cycles)
            break;
        if (run->simulation->cycles % RUN_LOOK_CYCLES == 0) {
            good = !interrupt_asked() && !run_outputs_failed(&run->outputs);
            show_progress(run);
        }
    }
    run->wall_ns += stopwatch_now_ns() - start_ns;
    progress_end(&run->progress);
    return good;
}

static enum summary_outcome outcome_of(const struct run *run)
{
    enum controller_state state = controller_get_state(&run->simulation->controller);

    if (state == CONTROLLER_FAULTED)
        return OUTCOME_FAULTED;
    return state == CONTROLLER_COMPLETED ? OUTCOME_COMPLETED : OUTCOME_STOPPED;
}

/* A fault is about a line of the program, or about the machine. */
static void report_fault(const struct run *run, const char *text)
{
    const struct diagnostic *fault = controller_get_fault(&run->simulation->controller);

    if (fault->line > 0)
        message_program_error(&run->session.program, fault);
    else
        message_command_error("%s", text);
}

static enum command_status finish(struct run *run)
{
    static struct summary summary;
    struct summary_source source = {
        .session = &run->session,
        .totals = &run->totals,
        .simulation = run->simulation,
        .judge = &run->judge,
        .outcome = outcome_of(run),
        .wall_time_s = 1e-9 * (double)run->wall_ns,
    };
    FILE *stream = run_outputs_use_stdout(&run->outputs) ? stderr : stdout;

    judge_finish(&run->judge, source.outcome == OUTCOME_COMPLETED);
    summary_set(&summary, &source);
    run->session.parameters.values = run->simulation->parameters;
    if (source.outcome != OUTCOME_COMPLETED)
        run_outputs_drop(&run->outputs,
                         RUN_PARAMETERS); /* the program is read ahead of what has been done */
    if (!run_outputs_commit(&run->outputs, &summary, &run->session.parameters))
        return STATUS_ENVIRONMENT;
    if (source.outcome == OUTCOME_FAULTED)
        report_fault(run, summary.fault);
    if (!run->session.options->quiet) {
        summary_write_text(stream, &summary);
        run_outputs_list(&run->outputs, stream);
    }
    return summary_held(&summary) ? STATUS_DONE : STATUS_FAILED;
}

static enum command_status simulate(struct run *run)
{
    run->simulation = simulation_open(&run->session);
    if (run->simulation == NULL) {
        message_command_error("out of memory");
        return STATUS_ENVIRONMENT;
    }
    if (!run_outputs_open(&run->outputs, &run->session, run->simulation))
        return STATUS_ENVIRONMENT;
    prepare_judge(run);
    set_until(run);
    progress_start(&run->progress, !run->session.options->quiet);
    if (run_loop(run))
        return finish(run);
    if (interrupt_asked())
        return STATUS_INTERRUPTED;
    message_command_error("the output files cannot be written");
    return STATUS_ENVIRONMENT;
}

static enum command_status execute(struct run *run, const struct options *options)
{
    enum command_status status = session_open(&run->session, options);

    if (status == STATUS_DONE && !run_outputs_plan(&run->outputs, &run->session))
        status = STATUS_INPUT;
    if (status == STATUS_DONE)
        status = session_check(&run->session, 1, &run->totals);
    if (status == STATUS_DONE)
        status = simulate(run);
    run_outputs_close(&run->outputs);
    simulation_close(run->simulation);
    session_close(&run->session);
    return status;
}

static enum command_status command_run_execute(const struct options *options)
{
    struct run *run = calloc(1, sizeof *run);
    enum command_status status;

    if (run == NULL) {
        message_command_error("out of memory");
        return STATUS_ENVIRONMENT;
    }
    status = execute(run, options);
    free(run);
    return status;
}

static const struct option_row rows[] = {
    OPTIONS_PROGRAM,
    {"save-parameters", OPTION_FLAG, offsetof(struct options, save_parameters), NULL,
     "write the parameters back at the end"},
    {"until", OPTION_NUMBER, offsetof(struct options, until_s), "SECONDS",
     "stop at this time of the program"},
    {"trace", OPTION_TEXT, offsetof(struct options, trace), "FILE.csv",
     "one row per control cycle"},
    {"bus-log", OPTION_TEXT, offsetof(struct options, bus_log), "FILE",
     "every CAN frame, as candump -L writes it"},
    {"report", OPTION_TEXT, offsetof(struct options, report), "FILE.html",
     "path, feed and limits as pictures"},
    {"json", OPTION_TEXT, offsetof(struct options, json), "FILE", "the summary for programs"},
    {"junit", OPTION_TEXT, offsetof(struct options, junit), "FILE",
     "the checks for CI servers, one case each"},
    {"quiet", OPTION_FLAG, offsetof(struct options, quiet), NULL, "no summary, no progress bar"},
    OPTIONS_END,
};

const struct command command_run = {
    .name = "run",
    .usage = "PROGRAM [options]",
    .summary = "run the firmware on a part program against the virtual machine",
    .help = "PROGRAM and every FILE may be - for standard input and output. The whole program is "
            "checked before\n"
            "anything moves. Output files appear complete at the end, or not at all.\n"
            "\n"
            "Exit status: 0 every check held; 1 a check failed or a drive faulted; 2 the program, "
            "a file or an\n"
            "option is wrong; 3 a file cannot be written; 130 interrupted.\n"
            "\n"
            "Examples:\n"
            "  takt run part.ngc --report part.html\n"
            "  takt run part.ngc --machine mill3.ini --trace part.csv --json -\n"
            "  takt run part.ngc --set axis.X.max_jerk_mm_s3=20000 --until 2.5\n",
    .options = rows,
    .operands_min = 1,
    .operands_max = 1,
    .run = command_run_execute,
};
