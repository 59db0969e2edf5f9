/* takt precision: errors of every interpolator on a program, with bounds and word lengths. */
#include "cli/interrupt.h"
#include "cli/message.h"
#include "findings/precision_findings.h"
#include "session/session.h"
#include "simulation/simulation.h"
#include "takt/command.h"

#include <stdlib.h>

/* Cycles between two looks at Ctrl-C. */
#define LOOK_CYCLES 4096

struct precision_job {
    struct session session;
    struct precision precision;
    struct simulation *simulation;
};

/* False: interrupted. */
static bool watch(struct precision_job *job)
{
    const struct controller *controller = &job->simulation->controller;

    while (takt_controller_get_state(controller) < CONTROLLER_COMPLETED) {
        const struct cycle_record *record;

        if (!simulation_step(job->simulation))
            return false;
        record = takt_controller_get_record(controller);
        if (record != NULL)
            precision_add(&job->precision, record, takt_controller_get_block(controller));
        if (job->simulation->cycles % LOOK_CYCLES == 0 && interrupt_asked())
            return false;
    }
    return true;
}

static enum command_status finish(struct precision_job *job)
{
    const struct controller *controller = &job->simulation->controller;
    const struct diagnostic *fault = takt_controller_get_fault(controller);
    char text[DIAGNOSTIC_TEXT_MAX];

    precision_finish(&job->precision);
    precision_findings_print(job->session.program.name, &job->precision);
    if (takt_controller_get_state(controller) == CONTROLLER_COMPLETED)
        return STATUS_DONE;
    (void)takt_diagnostic_text(fault, text);
    message_command_error("the program did not end: %s", text);
    return STATUS_FAILED;
}

static enum command_status run_program(struct precision_job *job)
{
    enum command_status status = simulation_open(&job->session, &job->simulation);

    if (status != STATUS_DONE)
        return status;
    precision_init(&job->precision, &job->session.setup.machine);
    return watch(job) ? finish(job) : STATUS_INTERRUPTED;
}

static enum command_status execute(struct precision_job *job, const struct options *options)
{
    struct session_totals totals;
    enum command_status status = session_open(&job->session, options);

    /* The setpoints all are compared with are the exact ones. */
    job->session.setup.machine.interpolator = INTERPOLATOR_EXACT;
    if (status == STATUS_DONE)
        status = session_check(&job->session, 1, &totals);
    if (status == STATUS_DONE)
        status = run_program(job);
    simulation_close(job->simulation);
    session_close(&job->session);
    return status;
}

static enum command_status command_precision_execute(const struct options *options)
{
    struct precision_job *job = calloc(1, sizeof *job);
    enum command_status status;

    if (job == NULL) {
        message_command_error("out of memory");
        return STATUS_ENVIRONMENT;
    }
    status = execute(job, options);
    free(job);
    return status;
}

static const struct option_row rows[] = {
    OPTIONS_PROGRAM,
    OPTIONS_END,
};

const struct command command_precision = {
    .name = "precision",
    .usage = "PROGRAM [options]",
    .summary = "errors of every interpolator on a program, with bounds and word lengths",
    .help = "Runs the program exactly and computes every setpoint by the other forms of "
            "interpolation as well: digital\n"
            "integration of lines, behind the same feed and with ramps of its own, rotation of the "
            "radius vector on arcs,\n"
            "and the step forms, with the steps_per_mm of each axis. Words are those of the keys "
            "interpolator_word_bits,\n"
            "interpolator_end_shift and interpolator_angle_bits. For each: the largest error "
            "measured, its bound, and the word length in "
            "bits. See README.md of\n"
            "firmware/classic and firmware/step.\n"
            "\n"
            "Examples:\n"
            "  takt precision part.ngc\n"
            "  takt precision part.ngc --machine mill3.ini --set axis.X.steps_per_mm=400\n",
    .options = rows,
    .operands_min = 1,
    .operands_max = 1,
    .run = command_precision_execute,
};
