/* A run of the library, cycle by cycle: opened, stepped, finished. */
#include "library/library_private.h"

#include "cli/axis_unit.h"
#include "cli/message.h"
#include "cli/stopwatch.h"
#include "compiled/compiled_verifier.h"
#include "simulation/error_map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define FAULTS_NAME "<faults>"

static void see(void *context, const struct cycle_record *record, const struct block *block)
{
    struct takt_job *job = context;

    if (record == NULL)
        return;
    if (job->keeps_trace)
        columns_add(&job->columns, record, simulation_get_tool(job->run.simulation));
    if (job->report != NULL)
        report_add(job->report, record, block->move.kind == MOVE_RAPID);
}

/* False after a message. */
static bool keep(struct takt_job *job, unsigned keeps)
{
    const struct machine *machine = &job->run.session.setup.machine;
    struct plan_limits limits;

    job->keeps_trace = (keeps & TAKT_KEEPS_TRACE) != 0;
    columns_init(&job->columns, takt_machine_axes(machine), 1e-6 * (double)machine->cycle_us,
                 simulation_get_tool(job->run.simulation) != NULL);
    if (keeps != 0)
        job->run.watcher = (struct run_watcher){see, job};
    if ((keeps & TAKT_KEEPS_REPORT) == 0)
        return true;
    takt_controller_plan_limits(machine, &limits);
    job->report = report_open(&limits);
    if (job->report == NULL)
        message_command_error("out of memory");
    return job->report != NULL;
}

static enum command_status start(struct takt_job *job, unsigned keeps)
{
    enum command_status status = library_read_options(job, &command_run);

    if (status != STATUS_DONE)
        return status;
    job->is_open = true;
    status = run_open(&job->run, &job->options);
    if (status == STATUS_DONE)
        status = run_prepare(&job->run);
    if (status == STATUS_DONE && !keep(job, keeps))
        status = STATUS_ENVIRONMENT;
    job->is_started = status == STATUS_DONE;
    return status;
}

int takt_start(struct takt_job *job, unsigned keeps)
{
    enum command_status status;

    library_enter(job);
    status = start(job, keeps);
    library_leave(job);
    return (int)status;
}

/* Why a cycle was the last. */
static enum command_status tell_why(const struct takt_job *job)
{
    const char *lost = drive_network_get_problem(&job->run.simulation->network);

    message_command_error("%s", lost != NULL ? lost : "out of memory");
    return STATUS_ENVIRONMENT;
}

static void keep_last(struct takt_job *job)
{
    const struct cycle_record *record = simulation_get_record(job->run.simulation);

    if (record != NULL)
        job->last = *record;
}

int takt_step(struct takt_job *job, uint64_t cycles)
{
    const uint64_t start_ns = stopwatch_now_ns();
    bool good = true;

    library_enter(job);
    for (uint64_t i = 0; i < cycles && good && !run_is_over(&job->run); i++) {
        good = run_cycle(&job->run) && !job->columns.failed;
        keep_last(job);
    }
    job->run.wall_ns += stopwatch_now_ns() - start_ns;
    if (!good)
        (void)tell_why(job);
    library_leave(job);
    return good ? STATUS_DONE : STATUS_ENVIRONMENT;
}

int takt_is_over(const struct takt_job *job)
{
    return run_is_over(&job->run) ? 1 : 0;
}

/* A fault is about a line of the program, or about the machine. */
static void tell_fault(const struct run *run)
{
    if (run->summary.outcome != OUTCOME_FAULTED)
        return;
    if (run->fault.line > 0)
        message_program_error(&run->session.program, &run->fault);
    else
        message_command_error("%s", run->summary.fault);
}

/* What the report shows beside the cycles: before the session goes. */
static void keep_pictures(struct takt_job *job)
{
    const struct run *run = &job->run;

    if (job->report == NULL)
        return;
    job->map = error_map_json(&run->session, run->simulation);
    if (run->session.compiled != NULL)
        job->shares = compiled_shares_json(&run->session, run->compiled.stream);
}

static enum command_status finish(struct takt_job *job, enum command_status cut)
{
    FILE *stream = library_open_text(job);

    if (stream == NULL)
        return STATUS_ENVIRONMENT;
    run_finish(&job->run, cut);
    job->is_finished = true;
    tell_fault(&job->run);
    keep_pictures(job);
    job->json = summary_json(&job->run.summary);
    if (job->json != NULL)
        (void)fprintf(stream, "%s\n", job->json);
    if (!announcer_finish(&job->run.simulation->announcer))
        return library_keep_text(job, stream, STATUS_ENVIRONMENT);
    return library_keep_text(job, stream, summary_status(&job->run.summary));
}

int takt_finish(struct takt_job *job, int cut)
{
    enum command_status status;

    library_enter(job);
    status = finish(job, (enum command_status)cut);
    library_leave(job);
    return (int)status;
}

static enum command_status write_report(struct takt_job *job)
{
    FILE *stream = library_open_text(job);

    if (stream == NULL || job->json == NULL || job->report == NULL)
        return STATUS_ENVIRONMENT;
    report_set_map(job->report, job->map);
    report_set_shares(job->report, job->shares);
    return library_keep_text(
        job, stream,
        report_write(job->report, stream, job->json) == 0 ? STATUS_DONE : STATUS_ENVIRONMENT);
}

int takt_write_report(struct takt_job *job)
{
    enum command_status status;

    library_enter(job);
    status = write_report(job);
    library_leave(job);
    return (int)status;
}

void library_close_run(struct takt_job *job)
{
    if (job->is_open)
        run_close(&job->run);
    job->is_open = false;
    columns_free(&job->columns);
    report_close(job->report);
    free(job->map);
    free(job->shares);
    free(job->json);
    job->report = NULL;
    job->map = NULL;
    job->shares = NULL;
    job->json = NULL;
}

/* ---- a look at the machine, and a hand on it ---- */

static void set_point(double at[6], const struct point *point)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        at[i] = point->at[i] * axis_unit_ratio(i);
}

void takt_get_state(const struct takt_job *job, struct takt_state *state)
{
    const struct simulation *s = job->run.simulation;
    const struct machine *machine = &job->run.session.setup.machine;
    const struct cycle_record *record = &job->last;
    struct point actual;

    takt_controller_get_actual(&s->controller, &actual);
    *state = (struct takt_state){.state = (int)takt_controller_get_state(&s->controller),
                                 .cycles = job->run.verifier.figures.cycles,
                                 .cycles_since_power = s->cycles,
                                 .axes = takt_machine_axes(machine),
                                 .cycle_s = 1e-6 * (double)machine->cycle_us,
                                 .override_percent = s->inputs.feed_override_percent,
                                 .digest = job->run.verifier.figures.digest};
    set_point(state->act, &actual);
    state->block = record->block;
    state->line = record->line;
    set_point(state->cmd, &record->cmd);
    set_point(state->set, &record->set);
    if (simulation_get_record(s) == NULL)
        return;
    state->feed_mm_min = record->feed_mm_s * 60.0;
    state->override_percent = record->override_percent;
}

void takt_get_inputs(const struct takt_job *job, struct takt_inputs *inputs)
{
    const struct simulation *s = job->run.simulation;

    *inputs = (struct takt_inputs){.feed_override_percent = s->feed_override.percent,
                                   .rapid_override_percent = s->rapid_override.percent,
                                   .feed_hold = s->inputs.feed_hold ? 1 : 0,
                                   .single_block = s->inputs.single_block ? 1 : 0,
                                   .digital = s->inputs.digital};
    memcpy(inputs->analogue, s->inputs.analogue, sizeof inputs->analogue);
}

/* False after a message. */
static bool can_be_set(const struct takt_inputs *inputs)
{
    for (unsigned i = 0; i < sizeof inputs->analogue / sizeof inputs->analogue[0]; i++) {
        if (!isfinite(inputs->analogue[i])) {
            message_command_error("input E%u is %g: a finite number is expected", i,
                                  inputs->analogue[i]);
            return false;
        }
    }
    return true;
}

static bool set_overrides(struct simulation *s, const struct takt_inputs *inputs)
{
    const bool good =
        simulation_set_overrides(s, inputs->feed_override_percent, inputs->rapid_override_percent);

    if (!good)
        message_command_error("overrides %g %% and %g %%: the feed override is 0 ... 120 %%, the "
                              "rapid override 0 ... 100 %%",
                              inputs->feed_override_percent, inputs->rapid_override_percent);
    return good;
}

int takt_set_inputs(struct takt_job *job, const struct takt_inputs *inputs)
{
    struct simulation *s = job->run.simulation;
    bool good;

    library_enter(job);
    good = can_be_set(inputs) && set_overrides(s, inputs);
    library_leave(job);
    if (!good)
        return STATUS_INPUT;
    s->inputs.feed_hold = inputs->feed_hold != 0;
    s->inputs.single_block = inputs->single_block != 0;
    s->inputs.digital = inputs->digital;
    memcpy(s->inputs.analogue, inputs->analogue, sizeof s->inputs.analogue);
    return STATUS_DONE;
}

int takt_add_faults(struct takt_job *job, const char *bytes, size_t length)
{
    bool good;

    library_enter(job);
    good = simulation_add_faults(job->run.simulation, FAULTS_NAME, bytes, length);
    library_leave(job);
    return good ? STATUS_DONE : STATUS_INPUT;
}

unsigned takt_count_drives(const struct takt_job *job)
{
    return job->run.simulation->network.drives.count;
}

unsigned takt_get_node(const struct takt_job *job, unsigned drive)
{
    return job->run.simulation->network.drives.drive[drive].servo.config.node;
}

double takt_get_position_mm(const struct takt_job *job, unsigned drive)
{
    return virtual_drive_get_position_mm(&job->run.simulation->network.drives.drive[drive]);
}

/* Objects of the dictionary are known by index, sub-index and bits. */
static uint32_t object_of(uint32_t index, uint32_t sub, unsigned bits)
{
    return index << 16 | sub << 8 | bits;
}

static bool can_be_object(uint32_t index, uint32_t sub)
{
    return index <= 0xFFFF && sub <= 0xFF;
}

unsigned takt_read_object(struct takt_job *job, unsigned drive, uint32_t index, uint32_t sub,
                          uint32_t *value)
{
    struct virtual_drive *d = &job->run.simulation->network.drives.drive[drive];

    for (unsigned bits = 8; bits <= 32 && can_be_object(index, sub); bits *= 2) {
        if (virtual_drive_read_object(d, object_of(index, sub, bits), value))
            return bits;
    }
    return 0;
}

unsigned takt_write_object(struct takt_job *job, unsigned drive, uint32_t index, uint32_t sub,
                           uint32_t value)
{
    struct virtual_drive *d = &job->run.simulation->network.drives.drive[drive];

    for (unsigned bits = 8; bits <= 32 && can_be_object(index, sub); bits *= 2) {
        if (virtual_drive_write_object(d, object_of(index, sub, bits), value))
            return bits;
    }
    return 0;
}

/* ---- the trace ---- */

unsigned takt_count_columns(const struct takt_job *job)
{
    return job->columns.count;
}

const char *takt_get_column_name(const struct takt_job *job, unsigned column)
{
    return job->columns.column[column].name;
}

uint64_t takt_count_rows(const struct takt_job *job)
{
    return job->columns.rows;
}

const double *takt_get_column(const struct takt_job *job, unsigned column)
{
    return job->columns.value[column];
}

double *takt_take_column(struct takt_job *job, unsigned column)
{
    double *value = job->columns.value[column];

    job->columns.value[column] = NULL;
    return value;
}
