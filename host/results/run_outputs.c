#define _POSIX_C_SOURCE 200809L

#include "results/run_outputs.h"

#include "cli/message.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static const char *const option_names[RUN_OUTPUT_COUNT] = {
    "trace", "bus-log", "report", "json", "junit", "save-parameters", "rests", "pulse-log"};

/* Parameters are read and saved in one file. */
static const char *replaced(const struct run_outputs *o, unsigned i)
{
    return i == RUN_PARAMETERS ? o->path[i] : NULL;
}

static bool check_input(const struct run_outputs *o, unsigned i)
{
    return replaced(o, i) != NULL || output_file_may_write(o->path[i]);
}

/* Only where the machine has errors does the tool stand elsewhere than the drives say. */
static bool check_rests(const struct session *session)
{
    struct tool_point point;

    tool_point_init(&point, &session->setup);
    if (!point.is_watched)
        message_command_error("--rests needs a machine with errors: [geometry] of its file, or "
                              "pitch_error_mm of a drive");
    return point.is_watched;
}

/* The axes with step drives. */
static unsigned stepped_axes(const struct machine *machine)
{
    unsigned axes = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++)
        axes |= machine_axis_is_stepped(&machine->axis[i]) ? 1u << i : 0;
    return axes;
}

static bool check_pulse_log(const struct session *session)
{
    const char *path = session->options->pulse_log;
    enum pulse_log_form form;

    if (stepped_axes(&session->setup.machine) == 0)
        message_command_error("--pulse-log needs a step drive: --drive-type step, or drive_type of "
                              "an axis in the machine file");
    else if (!pulse_log_form_of(path, &form))
        message_command_error("--pulse-log %s: a name that ends in .vcd or .csv is expected", path);
    else
        return true;
    return false;
}

bool run_outputs_plan(struct run_outputs *o, const struct session *session)
{
    const struct options *options = session->options;

    *o = (struct run_outputs){
        .path = {options->trace, options->bus_log, options->report, options->json, options->junit}};
    if (options->save_parameters) {
        o->path[RUN_PARAMETERS] = session->parameter_path;
        if (session->parameter_path == NULL) {
            message_command_error(
                "--save-parameters needs --parameters, or parameter_file in the machine file");
            return false;
        }
    }
    o->path[RUN_RESTS] = options->rests;
    o->path[RUN_PULSE_LOG] = options->pulse_log;
    if ((options->rests != NULL && !check_rests(session)) ||
        (options->pulse_log != NULL && !check_pulse_log(session)))
        return false;
    for (unsigned i = 0; i < RUN_OUTPUT_COUNT; i++) {
        if (o->path[i] != NULL && !check_input(o, i))
            return false;
    }
    if (!output_file_differ(option_names, o->path, RUN_OUTPUT_COUNT))
        return false;
    o->each_cycle = options->trace != NULL || options->bus_log != NULL || options->report != NULL;
    return true;
}

bool run_outputs_use_stdout(const struct run_outputs *o)
{
    for (unsigned i = 0; i < RUN_OUTPUT_COUNT; i++) {
        if (o->path[i] != NULL && strcmp(o->path[i], "-") == 0)
            return true;
    }
    return false;
}

static bool open_bus_log(struct run_outputs *o, struct simulation *simulation)
{
    o->bus_log = malloc(sizeof *o->bus_log);
    o->frames = calloc(1, sizeof *o->frames);
    if (o->bus_log == NULL || o->frames == NULL)
        return false;
    candump_init(o->bus_log, o->file[RUN_BUS_LOG].stream, "can0");
    drive_network_log(&simulation->network, o->frames, o->bus_log);
    return true;
}

static bool open_trace(struct run_outputs *o, const struct machine *machine)
{
    o->trace = malloc(sizeof *o->trace);
    if (o->trace == NULL)
        return false;
    trace_writer_init(o->trace, o->file[RUN_TRACE].stream, takt_machine_axes(machine),
                      1e-6 * (double)machine->cycle_us, o->tool != NULL);
    return true;
}

static bool open_report(struct run_outputs *o, const struct machine *machine)
{
    struct plan_limits limits;

    if (report_get_plots_missing() != NULL)
        (void)fprintf(stderr, "takt run: warning: %s\n", report_get_plots_missing());
    takt_controller_plan_limits(machine, &limits);
    o->report = report_open(&limits);
    return o->report != NULL;
}

static bool open_writers(struct run_outputs *o, const struct machine *machine,
                         struct simulation *simulation)
{
    o->tool = simulation_get_tool(simulation);
    return (o->path[RUN_TRACE] == NULL || open_trace(o, machine)) &&
           (o->path[RUN_BUS_LOG] == NULL || open_bus_log(o, simulation)) &&
           (o->path[RUN_REPORT] == NULL || open_report(o, machine));
}

/* Written by who knows where the tool is. */
static bool open_rests(struct run_outputs *o, struct simulation *simulation)
{
    if (o->path[RUN_RESTS] == NULL)
        return true;
    if (!simulation->tool_point.is_watched) {
        message_command_error("--rests needs drives inside of takt");
        return false;
    }
    tool_point_write_rests(&simulation->tool_point, o->file[RUN_RESTS].stream);
    return true;
}

/* Written by the drives, each pulse as they take it. */
static void open_pulse_log(struct run_outputs *o, const struct machine *machine,
                           struct simulation *simulation)
{
    struct pulse_log_config config = {.axes = stepped_axes(machine)};

    if (o->path[RUN_PULSE_LOG] == NULL)
        return;
    (void)pulse_log_form_of(o->path[RUN_PULSE_LOG], &config.form);
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        config.rate_max_hz[i] = machine->axis[i].step_rate_max_hz;
    pulse_log_begin(&o->pulse_log, o->file[RUN_PULSE_LOG].stream, &config);
    virtual_steppers_listen(&simulation->network.steppers,
                            &(struct virtual_steppers_listener){pulse_log_take, &o->pulse_log});
}

bool run_outputs_open(struct run_outputs *o, const struct session *session,
                      struct simulation *simulation)
{
    for (unsigned i = 0; i < RUN_OUTPUT_COUNT; i++) {
        if (o->path[i] != NULL && !output_file_replace(&o->file[i], o->path[i], replaced(o, i))) {
            run_outputs_close(o);
            return false;
        }
    }
    if (!open_rests(o, simulation)) {
        run_outputs_close(o);
        return false;
    }
    open_pulse_log(o, &session->setup.machine, simulation);
    if (open_writers(o, &session->setup.machine, simulation))
        return true;
    message_command_error("out of memory");
    run_outputs_close(o);
    return false;
}

void run_outputs_add(struct run_outputs *o, const struct cycle_record *record,
                     const struct block *block)
{
    if (o->frames != NULL)
        frame_buffer_write(o->frames);
    if (record == NULL)
        return;
    if (o->trace != NULL)
        trace_writer_add(o->trace, record, o->tool);
    if (o->report != NULL)
        report_add(o->report, record, block->move.kind == MOVE_RAPID);
}

bool run_outputs_failed(const struct run_outputs *o)
{
    return (o->trace != NULL && o->trace->failed) || (o->bus_log != NULL && o->bus_log->failed) ||
           (o->path[RUN_PULSE_LOG] != NULL && pulse_log_has_failed(&o->pulse_log));
}

bool run_outputs_tell_failed(struct run_outputs *o)
{
    bool told = false;

    for (unsigned i = 0; i < RUN_OUTPUT_COUNT; i++)
        told = (o->path[i] != NULL && output_file_tell_failed(&o->file[i])) || told;
    return told;
}

void run_outputs_drop(struct run_outputs *o, enum run_output which)
{
    output_file_discard(&o->file[which]);
    o->path[which] = NULL;
}

void run_outputs_set_map(struct run_outputs *o, char *map)
{
    o->map = map;
}

void run_outputs_set_shares(struct run_outputs *o, char *shares)
{
    o->shares = shares;
}

/* False: out of memory, or errno says what the report could not do. */
static bool write_end(struct run_outputs *o, const struct summary *summary,
                      const struct parameter_file *parameters)
{
    char *json = summary_json(summary);
    bool good = json != NULL;

    if (good && o->path[RUN_JSON] != NULL)
        (void)fprintf(o->file[RUN_JSON].stream, "%s\n", json);
    if (good && o->report != NULL) {
        report_set_map(o->report, o->map);
        report_set_shares(o->report, o->shares);
        good = report_write(o->report, o->file[RUN_REPORT].stream, json) == 0;
    }
    free(json);
    if (o->path[RUN_JUNIT] != NULL)
        summary_write_junit(o->file[RUN_JUNIT].stream, summary);
    if (o->path[RUN_PARAMETERS] != NULL)
        parameter_file_write(o->file[RUN_PARAMETERS].stream, parameters);
    return good;
}

static bool finish_files(struct run_outputs *o)
{
    for (unsigned i = 0; i < RUN_OUTPUT_COUNT; i++) {
        if (o->path[i] != NULL && !output_file_finish(&o->file[i]))
            return false;
    }
    return true;
}

static bool place_files(struct run_outputs *o)
{
    for (unsigned i = 0; i < RUN_OUTPUT_COUNT; i++) {
        if (o->path[i] != NULL && !output_file_place(&o->file[i]))
            return false;
    }
    return true;
}

bool run_outputs_commit(struct run_outputs *o, const struct summary *summary,
                        const struct parameter_file *parameters)
{
    bool good = write_end(o, summary, parameters);

    if (o->trace != NULL)
        good = trace_writer_flush(o->trace) && good;
    if (o->bus_log != NULL)
        good = candump_flush(o->bus_log) && good;
    if (o->path[RUN_PULSE_LOG] != NULL)
        good = pulse_log_end(&o->pulse_log) && good;
    if (!good && run_outputs_tell_failed(o))
        return false;
    if (!good) {
        message_command_error("the output files cannot be written: %s",
                              errno != 0 ? strerror(errno) : "out of memory");
        return false;
    }
    return finish_files(o) && place_files(o);
}

void run_outputs_list(const struct run_outputs *o, FILE *stream)
{
    static const char *const labels[RUN_OUTPUT_COUNT] = {
        "trace", "bus log", "report", "JSON", "JUnit", "parameters", "rests", "pulse log"};

    for (unsigned i = 0; i < RUN_OUTPUT_COUNT; i++) {
        if (o->path[i] != NULL)
            (void)fprintf(stream, "  %-13s %s\n", labels[i], o->path[i]);
    }
}

void run_outputs_close(struct run_outputs *o)
{
    for (unsigned i = 0; i < RUN_OUTPUT_COUNT; i++)
        output_file_discard(&o->file[i]);
    free(o->trace);
    free(o->bus_log);
    free(o->frames);
    report_close(o->report);
    free(o->map);
    free(o->shares);
    o->map = NULL;
    o->shares = NULL;
    o->trace = NULL;
    o->bus_log = NULL;
    o->frames = NULL;
    o->report = NULL;
}
