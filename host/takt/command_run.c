#include "takt/command.h"
#include "takt/compiled.h"
#include "takt/compiled_judge.h"
#include "takt/drives_table.h"
#include "takt/ending.h"
#include "takt/error_map.h"
#include "takt/interrupt.h"
#include "takt/judge.h"
#include "takt/message.h"
#include "takt/progress.h"
#include "takt/run_outputs.h"
#include "takt/session.h"
#include "takt/simulation.h"
#include "takt/stopwatch.h"
#include "takt/summary.h"
#include "takt/target_setup.h"

#include <stdlib.h>
#include <string.h>

/* Cycles between two looks at failed writes and the progress bar. */
#define RUN_LOOK_CYCLES 1024

struct run {
    struct session session;
    struct session_totals totals;
    struct session_reading reading[2]; /* the judge's */
    struct judge judge;
    struct compiled compiled;
    uint32_t answers; /* of the run that the judge has been told */
    struct simulation *simulation;
    struct run_outputs outputs;
    struct progress progress;
    struct ending ending;
    bool has_told_drives;    /* what they do without */
    struct diagnostic fault; /* before its end */
    enum command_status cut; /* not STATUS_DONE: the run ends before its time, with this status */
    uint64_t until_cycles;   /* program cycles after which to stop; UINT64_MAX: the program's end */
    uint64_t wall_ns;
};

static void prepare_judge(struct run *run)
{
    const struct machine *machine = &run->session.setup.machine;
    struct program_config config;
    struct source source;

    session_begin_reading(&run->session, &run->reading[0], &config, &source);
    judge_init(&run->judge, machine, &config, &source);
    session_begin_reading(&run->session, &run->reading[1], &config, &source);
    judge_follow(&run->judge, machine, &config, &source, run->session.compiled != NULL);
}

static void set_until(struct run *run)
{
    double cycle_s = 1e-6 * (double)run->session.setup.machine.cycle_us;
    double cycles = run->session.options->until_s / cycle_s;

    /* Half a cycle of room: 0.1 s are 100 cycles of 1 ms, whatever the division's last bit says. */
    run->until_cycles =
        run->session.options->until_s > 0 && cycles < 1e18 ? (uint64_t)(cycles + 0.5) : UINT64_MAX;
}

/* At most one in a cycle. */
static void tell_answers(struct run *run)
{
    struct program_answer answer;
    uint32_t answers = controller_get_answers(&run->simulation->controller, &answer);

    if (answers != run->answers)
        judge_answer(&run->judge, &answer);
    run->answers = answers;
}

/* One cycle of the world and of everybody who watches it. False: interrupted, or the bus is gone. */
static bool run_cycle(struct run *run)
{
    const struct cycle_record *record;
    const struct block *block;
    bool good = simulation_step(run->simulation);

    tell_answers(run);
    record = simulation_get_record(run->simulation);
    block = controller_get_block(&run->simulation->controller);
    if (record != NULL && block != NULL) /* a target may differ, which is told */
        good = judge_add(&run->judge, record, block) && good;
    if (run->outputs.each_cycle) {
        uint64_t start_ns = stopwatch_now_ns();

        run_outputs_add(&run->outputs, record, block);
        run->wall_ns -= stopwatch_now_ns() - start_ns; /* writing is not the run's time */
    }
    return good;
}

static void show_progress(struct run *run)
{
    const struct judge_figures *figures = &run->judge.figures;
    double motions = run->totals.last > 0 ? (double)run->totals.last : 1;

    progress_show(&run->progress, (double)figures->blocks / motions,
                  (double)figures->cycles * 1e-6 * (double)run->session.setup.machine.cycle_us);
}

static bool is_bus_lost(const struct run *run)
{
    return field_get_problem(&run->simulation->field) != NULL;
}

/* Runs to the program's end, a fault, --until or a signal. False: a file cannot be written, or the bus is gone. */
/* Drives on a bus outside are others' drives: what they do without is told before they have done it, not after. */
static void tell_drives(struct run *run)
{
    const struct drives *drives = controller_get_drives(&run->simulation->controller);

    run->has_told_drives = run->simulation->field.link == NULL ||
                           drives_table_tell(drives, run->session.options->quiet);
}

static bool run_loop(struct run *run)
{
    const struct controller *controller = &run->simulation->controller;
    uint64_t start_ns = stopwatch_now_ns();
    bool good = true;

    while (controller_get_state(controller) < CONTROLLER_COMPLETED && good && !interrupt_asked()) {
        good = run_cycle(run);
        if (!run->has_told_drives)
            tell_drives(run);
        if (run->judge.figures.cycles >= run->until_cycles)
            break;
        if (run->simulation->cycles % RUN_LOOK_CYCLES == 0) {
            good = good && !run_outputs_failed(&run->outputs);
            show_progress(run);
        }
    }
    run->wall_ns += stopwatch_now_ns() - start_ns;
    progress_end(&run->progress);
    return good;
}

/* The way to rest of a run that is cut short is part of it: trace and judge see it. */
static void end_cycle(struct run *run)
{
    if (run->cut != STATUS_DONE) {
        (void)run_cycle(run);
        return;
    }
    (void)simulation_step(run->simulation);
    if (run->outputs.each_cycle)
        run_outputs_add(&run->outputs, NULL, NULL);
}

/* Drives of a target are the target's: they end with its process. */
static void end_drives(struct run *run)
{
    struct controller *controller = &run->simulation->controller;

    if (run->simulation->has_target)
        return;
    run->ending.stays_on = run->session.setup.drives_stay_on != 0;
    ending_ask(&run->ending, controller, ENDING_ON_PATH);
    while (!is_bus_lost(run) && !ending_is_over(&run->ending, controller)) {
        end_cycle(run);
        ending_ask(&run->ending, controller, ending_by_signals());
    }
}

static enum summary_outcome outcome_of(const struct run *run)
{
    enum controller_state state = controller_get_state(&run->simulation->controller);

    if (run->cut != STATUS_DONE)
        return OUTCOME_INTERRUPTED;
    if (state == CONTROLLER_FAULTED)
        return OUTCOME_FAULTED;
    return state == CONTROLLER_COMPLETED ? OUTCOME_COMPLETED : OUTCOME_STOPPED;
}

/* A fault is about a line of the program, or about the machine. */
static void report_fault(const struct run *run, const char *text)
{
    if (run->fault.line > 0)
        message_program_error(&run->session.program, &run->fault);
    else
        message_command_error("%s", text);
}

/* A run that is cut short comes to rest first, so that the summary counts the way there. */
static void sum_up(struct run *run, struct summary *summary)
{
    struct summary_source source = {
        .session = &run->session,
        .totals = &run->totals,
        .simulation = run->simulation,
        .judge = &run->judge,
        .outcome = outcome_of(run),
        .interrupted = run->cut,
        .wall_time_s = 1e-9 * (double)run->wall_ns,
    };

    run->fault = *controller_get_fault(&run->simulation->controller);
    if (run->cut != STATUS_DONE)
        end_drives(run);
    judge_finish(&run->judge, source.outcome == OUTCOME_COMPLETED);
    summary_set(summary, &source);
    if (run->cut == STATUS_DONE)
        end_drives(run);
    summary->bus_frames = field_get_frames(&run->simulation->field);
}

static enum command_status finish(struct run *run)
{
    static struct summary summary;
    FILE *stream = run_outputs_use_stdout(&run->outputs) ? stderr : stdout;

    sum_up(run, &summary);
    run->session.parameters.values = run->simulation->parameters;
    if (summary.outcome != OUTCOME_COMPLETED)
        run_outputs_drop(&run->outputs,
                         RUN_PARAMETERS); /* the program is read ahead of what has been done */
    if (run->session.options->report != NULL)
        run_outputs_set_map(&run->outputs, error_map_json(&run->session, run->simulation));
    if (run->session.options->report != NULL && run->session.compiled != NULL)
        run_outputs_set_shares(&run->outputs,
                               compiled_shares_json(&run->session, run->compiled.stream));
    if (!announcer_finish(&run->simulation->announcer) ||
        !run_outputs_commit(&run->outputs, &summary, &run->session.parameters))
        return STATUS_ENVIRONMENT;
    if (summary.outcome == OUTCOME_FAULTED)
        report_fault(run, summary.fault);
    if (is_bus_lost(run))
        message_command_error("%s", field_get_problem(&run->simulation->field));
    if (!run->session.options->quiet) {
        summary_write_text(stream, &summary);
        run_outputs_list(&run->outputs, stream);
    }
    return summary_status(&summary);
}

/* What nothing can be kept for. */
static enum command_status tell_why(const struct run *run)
{
    if (run->judge.tube.path.failed)
        message_command_error("out of memory");
    else if (run->simulation->target.problem[0] != '\0')
        message_command_error("--target: %s", run->simulation->target.problem);
    else
        message_command_error("the output files cannot be written");
    return STATUS_ENVIRONMENT;
}

static enum command_status cut_by_signal(const struct run *run)
{
    if (!interrupt_asked() ||
        controller_get_state(&run->simulation->controller) >= CONTROLLER_COMPLETED)
        return STATUS_DONE;
    return (enum command_status)interrupt_status();
}

static enum command_status simulate(struct run *run)
{
    enum command_status status = simulation_open(&run->session, &run->simulation);

    if (status != STATUS_DONE)
        return status;
    if (!run_outputs_open(&run->outputs, &run->session, run->simulation))
        return STATUS_ENVIRONMENT;
    prepare_judge(run);
    set_until(run);
    progress_start(&run->progress, !run->session.options->quiet);
    run->cut = run_loop(run) ? cut_by_signal(run) : STATUS_ENVIRONMENT;
    if (run->cut != STATUS_ENVIRONMENT || is_bus_lost(run))
        return finish(run);
    end_drives(run);
    return tell_why(run);
}

/* Who plans: the controller as it runs, or takt before it. */
static enum command_status plan(struct run *run, const struct options *options)
{
    const char *how = options->plan;
    enum command_status status;

    if (how == NULL || strcmp(how, "board") == 0)
        return STATUS_DONE;
    if (options->override_method != NULL)
        message_command_warning("--override-method %s is not used: what is planned ahead of the "
                                "run changes its rate in its own way",
                                options->override_method);
    status = compiled_open(&run->compiled, &run->session, &run->totals,
                           strcmp(how, "ahead") == 0 ? NULL : how);
    run->session.compiled = &run->compiled;
    return status;
}

static enum command_status execute(struct run *run, const struct options *options)
{
    struct field_options field = {
        .bus = options->bus,
        .drives = options->drives,
        .is_paced = options->realtime,
        .has_script = options->inject != NULL,
    };
    enum command_status status =
        field_check_options(&field) ? session_open(&run->session, options) : STATUS_INPUT;

    run->session.runs = true;
    if (status == STATUS_DONE)
        status = target_setup_check(&run->session);
    if (status == STATUS_DONE && !run_outputs_plan(&run->outputs, &run->session))
        status = STATUS_INPUT;
    if (status == STATUS_DONE)
        status = session_check(&run->session, 1, &run->totals);
    if (status == STATUS_DONE)
        status = plan(run, options);
    if (status == STATUS_DONE)
        status = simulate(run);
    run_outputs_close(&run->outputs);
    simulation_close(run->simulation);
    judge_free(&run->judge);
    compiled_close(&run->compiled);
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
    OPTIONS_DRIVEN,
    {"save-parameters", OPTION_FLAG, offsetof(struct options, save_parameters), NULL,
     "write the parameters back at the end"},
    {"until", OPTION_NUMBER, offsetof(struct options, until_s), "SECONDS",
     "stop at this time of the program"},
    {"bus", OPTION_TEXT, offsetof(struct options, bus), "BUS",
     "embedded (default), socketcan:IF, slcan:PATH, socketcand:HOST:PORT"},
    {"drives", OPTION_TEXT, offsetof(struct options, drives), "WHERE",
     "internal on the embedded bus, external on any other"},
    {"realtime", OPTION_FLAG, offsetof(struct options, realtime), NULL,
     "paced by the clock instead of as fast as possible"},
    {"plan", OPTION_TEXT, offsetof(struct options, plan), "HOW",
     "board (default): while it runs; ahead: compiled first; or a FILE of takt compile"},
    {"target", OPTION_TEXT, offsetof(struct options, target), "NAME",
     "run the controller in QEMU, on a Cortex-M4 (m4f) or M7 (m7), compared bit for bit"},
    {"image", OPTION_TEXT, offsetof(struct options, image), "FILE",
     "its image, takt-desk.elf; host/run --target builds it"},
    {"trace", OPTION_TEXT, offsetof(struct options, trace), "FILE.csv",
     "one row per control cycle"},
    {"rests", OPTION_TEXT, offsetof(struct options, rests), "FILE.csv",
     "tool point at every standstill of 50 ms and more, on a machine with errors"},
    {"inject", OPTION_TEXT, offsetof(struct options, inject), "FILE",
     "scripted faults of bus and drives; takt help inject explains them"},
    {"probe", OPTION_TEXT, offsetof(struct options, probe), "FILE",
     "what the probe touches, and inputs over time: box, ball, input; see host/probe"},
    {"override", OPTION_TEXT, offsetof(struct options, override), "FILE",
     "feed override over time: lines of seconds and percent, 0 ... 120"},
    {"rapid-override", OPTION_TEXT, offsetof(struct options, rapid_override), "FILE",
     "rapid override over time, 0 ... 100"},
    {"override-method", OPTION_TEXT, offsetof(struct options, override_method), "METHOD",
     "adaptive (default) or proportional: see firmware/motion"},
    {"bus-log", OPTION_TEXT, offsetof(struct options, bus_log), "FILE",
     "every CAN frame, as candump -L writes it"},
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
