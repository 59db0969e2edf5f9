#include "simulation/simulation.h"

#include "cli/message.h"
#include "cli/stopwatch.h"
#include "compiled/compiled.h"
#include "config/shaper.h"
#include "simulation/cutting_feed.h"
#include "simulation/target_setup.h"
#include "tables/inject_file.h"
#include "tables/probe_file.h"
#include "tables/stock_file.h"

#include <stdlib.h>

/* The panel's ranges. */
#define FEED_PERCENT_MAX  120
#define RAPID_PERCENT_MAX 100

/* Contacts go into the program's own file. */
static void note_contact(struct simulation *s)
{
    struct program_answer answer;
    const uint32_t answers = takt_controller_get_answers(&s->controller, &answer);

    if (answers != s->answers && answer.contact)
        announcer_add_contact(&s->announcer, &s->parameters);
    s->answers = answers;
}

/* The contact of the move before comes first. */
static void say(void *simulation, const struct program *p)
{
    struct simulation *s = simulation;

    note_contact(s);
    announcer_say(&s->announcer, p);
}

static void start_controller(struct simulation *s, const struct session *session,
                             struct can_buses can)
{
    struct controller_config config = {
        .machine = &session->setup.machine,
        .can = can,
        .dcf = session->configurations.dcf,
        .step = drive_network_get_step_port(&s->network),
        .tools = &session->tools.table,
        .correction = session->correction,
        .shape = shaper_prepare(&session->setup, &s->shape),
        .compiled = session->compiled != NULL ? &session->compiled->source : NULL,
        .reader = &s->reader,
        .parameters = &s->parameters,
        .say = say,
        .listener = s,
        .exact_path = session->options->exact_path,
        .block_delete = session->options->block_delete,
        .from_line = session->options->from_line,
    };

    s->parameters = session->parameters.values;
    announcer_init(&s->announcer, &session->program);
    program_text_read(&session->program, &s->text, &config.source);
    takt_controller_init(&s->controller, &config);
    message_controller_warning(&s->controller);
}

/* The one of this process; with a target, that as well. */
static enum command_status start_controllers(struct simulation *s, const struct session *session)
{
    const struct can_buses can = drive_network_get_port(&s->network);
    enum command_status status;

    s->has_target = session->options->target != NULL;
    if (!s->has_target) {
        start_controller(s, session, can);
        return STATUS_DONE;
    }
    if (session->setup.shaper != SHAPER_NONE) {
        message_command_error("machine.shaper: a target does not shape setpoints");
        return STATUS_INPUT;
    }
    status = target_setup_open(&s->target, session, &can.port[0]);
    if (status == STATUS_DONE)
        start_controller(s, session, can_single(target_get_port(&s->target)));
    return status;
}

/* The nodes that faults may name. */
static unsigned list_nodes(const struct machine *machine,
                           uint16_t nodes[MACHINE_NODES_MAX + IO_NODES_MAX])
{
    unsigned count = 0;

    for (unsigned bus = 0; bus < takt_machine_bus_count(machine); bus++) {
        uint8_t node[MACHINE_NODES_MAX];
        const unsigned drives = takt_machine_bus_nodes(machine, bus, node);

        for (unsigned i = 0; i < drives; i++)
            nodes[count++] = INJECT_ADDRESS(bus, node[i]);
    }
    for (unsigned i = 0; i < takt_machine_io_count(machine); i++)
        nodes[count++] = INJECT_ADDRESS(machine->io[i].bus, machine->io[i].node);
    return count;
}

static enum command_status load_faults(struct simulation *s, const struct session *session)
{
    const char *path = session->options->inject;
    uint16_t nodes[MACHINE_NODES_MAX + IO_NODES_MAX];
    const unsigned count = list_nodes(&session->setup.machine, nodes);

    if (path == NULL || (inject_file_load(&s->script, path) &&
                         inject_file_check_nodes(&s->script, path, nodes, count)))
        return STATUS_DONE;
    return STATUS_INPUT;
}

static void free_files(struct simulation *s)
{
    stock_file_free(&s->stock);
    override_file_free(&s->feed_override);
    override_file_free(&s->rapid_override);
}

enum command_status simulation_open(const struct session *session, struct simulation **opened)
{
    const struct options *options = session->options;
    struct drive_network_options network = {.bus = options->bus,
                                            .drives = options->drives,
                                            .drive_image = options->drive_image,
                                            .is_paced = options->realtime};
    struct simulation *s = calloc(1, sizeof *s);
    struct virtual_spindle_config spindle;
    enum command_status status;

    *opened = NULL;
    if (s == NULL) {
        message_command_error("out of memory");
        return STATUS_ENVIRONMENT;
    }
    cycle_cost_init(&s->cost);
    s->inputs = inputs_idle();
    spindle = machine_setup_get_spindle(&session->setup);
    virtual_spindle_init(&s->spindle, &spindle);
    if (options->inject != NULL)
        network.script = &s->script;
    status = load_faults(s, session);
    if (status == STATUS_DONE &&
        !(probe_file_load(&s->probe, options->probe) && stock_file_load(&s->stock, options->stock)))
        status = STATUS_INPUT;
    if (status == STATUS_DONE &&
        !(override_file_load(&s->feed_override, options->override, FEED_PERCENT_MAX) &&
          override_file_load(&s->rapid_override, options->rapid_override, RAPID_PERCENT_MAX)))
        status = STATUS_INPUT;
    if (status == STATUS_DONE)
        status = drive_network_open(&s->network, &session->setup, &network);
    if (status != STATUS_DONE) {
        free_files(s);
        free(s);
        return status;
    }
    status = start_controllers(s, session);
    if (status != STATUS_DONE) {
        simulation_close(s);
        return status;
    }
    drive_network_watch_drives(&s->network, takt_controller_get_drives(&s->controller));
    probe_contact_wire(&s->contact, &s->probe, &session->setup.machine, &s->network.drives);
    tool_point_init(&s->tool_point, &session->setup);
    correction_watch_init(&s->correction, s->tool_point.cycle_s);
    s->program = session->program.name;
    s->tool_point.is_watched = s->tool_point.is_watched && !s->network.is_outside;
    *opened = s;
    return STATUS_DONE;
}

void simulation_close(struct simulation *s)
{
    if (s == NULL)
        return;
    if (s->has_target)
        target_close(&s->target);
    announcer_close(&s->announcer);
    drive_network_close(&s->network);
    free_files(s);
    free(s);
}

bool simulation_set_overrides(struct simulation *s, double feed_percent, double rapid_percent)
{
    if (!(feed_percent >= 0 && feed_percent <= FEED_PERCENT_MAX && rapid_percent >= 0 &&
          rapid_percent <= RAPID_PERCENT_MAX))
        return false;
    s->feed_override.percent = feed_percent;
    s->rapid_override.percent = rapid_percent;
    return true;
}

bool simulation_add_faults(struct simulation *s, const char *name, const char *bytes, size_t length)
{
    uint16_t nodes[MACHINE_NODES_MAX + IO_NODES_MAX];
    const unsigned count = list_nodes(&s->controller.machine, nodes);
    const unsigned first = s->script.count;
    struct inject_error error;
    struct inject added;

    if (!inject_read(&added, bytes, length, &error)) {
        message_error(name, error.line, error.column, "%s", error.text);
        return false;
    }
    if (!inject_file_check_nodes(&added, name, nodes, count))
        return false;
    if (added.count > INJECT_FAULTS_MAX - first) {
        message_error(name, 0, 0, "with those before there are more than %d faults",
                      INJECT_FAULTS_MAX);
        return false;
    }
    for (unsigned i = 0; i < added.count; i++)
        s->script.fault[s->script.count++] = added.fault[i];
    return drive_network_add_faults(&s->network, &s->script, first);
}

static void measured_cycle(struct simulation *s)
{
    uint64_t start_ns = stopwatch_now_ns();

    takt_controller_cycle(&s->controller, &s->inputs);
    cycle_cost_add(&s->cost, stopwatch_now_ns() - start_ns);
}

/* What the machine meets where it is now. */
static void set_inputs(struct simulation *s)
{
    const double cycle_s = machine_cycle_s(&s->controller.machine);
    const double time_s = cycle_s * (double)(s->cycles - s->begun);
    struct point at;

    takt_controller_get_actual(&s->controller, &at);
    s->contact.at = at;
    virtual_probe_set_inputs(&s->probe, time_s, &at, &s->inputs);
    s->inputs.feed_override_percent = override_file_at(&s->feed_override, time_s);
    s->inputs.rapid_override_percent = override_file_at(&s->rapid_override, time_s);
}

/* The world moves on; the controller hears of it what a temperature sensor says. */
static void follow_tool_point(struct simulation *s)
{
    struct tool_point *t = &s->tool_point;
    struct point at;

    if (!t->is_watched)
        return;
    drive_network_get_axes(&s->network, &s->controller.machine, &at);
    tool_point_follow(t, &at, (double)s->cycles * t->cycle_s,
                      takt_controller_get_record(&s->controller),
                      takt_controller_get_block(&s->controller));
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        s->rise_k[i] = deviation_sensor_k(&t->real);
        takt_correction_set_rise(takt_controller_get_correction(&s->controller), (enum axis)i,
                                 s->rise_k[i]);
    }
}

static void watch_correction(struct simulation *s)
{
    const struct cycle_record *record = takt_controller_get_record(&s->controller);

    if (record != NULL)
        correction_watch_add(&s->correction, takt_controller_get_correction(&s->controller), record,
                             s->program);
}

static double cut_depth_mm(const struct simulation *s)
{
    const struct cycle_record *record = takt_controller_get_record(&s->controller);

    if (s->stock.rows == 0 || record == NULL)
        return s->spindle.config.cut_depth_mm;
    return stock_depth_mm(&s->stock, record->cmd.at[AXIS_X], record->cmd.at[AXIS_Y],
                          record->cmd.at[AXIS_Z]);
}

/* The spindle turns on by a cycle, and reports. */
static void step_spindle(struct simulation *s)
{
    const double cycle_s = machine_cycle_s(&s->controller.machine);
    const double cut_nm =
        virtual_spindle_cut_nm(&s->spindle, cutting_feed_mm_s(&s->controller), cut_depth_mm(s));

    s->inputs.spindle = virtual_spindle_step(
        &s->spindle, cycle_s, takt_controller_get_outputs(&s->controller)->spindle_speed_rpm,
        cut_nm);
}

/* One cycle of the controller, or of both. */
static bool control(struct simulation *s)
{
    takt_controller_background(&s->controller);
    set_inputs(s);
    if (s->has_target && !target_begin_cycle(&s->target, &s->inputs, s->rise_k))
        return false;
    if (s->cycles % CYCLE_COST_EVERY == 0)
        measured_cycle(s);
    else
        takt_controller_cycle(&s->controller, &s->inputs);
    return !s->has_target || target_end_cycle(&s->target, &s->controller);
}

const struct cycle_record *simulation_get_record(const struct simulation *s)
{
    return s->has_target ? target_get_record(&s->target)
                         : takt_controller_get_record(&s->controller);
}

const struct point *simulation_get_tool(const struct simulation *s)
{
    return s->tool_point.is_watched ? &s->tool_point.tool : NULL;
}

/*
 * Drives that boot, or are switched off, are another matter than operation: other frames come then.
 */
static void count_responses(struct simulation *s)
{
    if (!s->has_begun && takt_controller_get_record(&s->controller) != NULL) {
        s->has_begun = true;
        drive_network_clear_responses(&s->network);
    }
    if (s->has_begun &&
        drives_get_state(takt_controller_get_drives(&s->controller)) != DRIVES_ENABLED)
        drive_network_end_responses(&s->network);
}

bool simulation_step(struct simulation *s)
{
    if (!control(s))
        return false;
    note_contact(s);
    step_spindle(s);
    count_responses(s);
    s->cycles++;
    if (takt_controller_get_state(&s->controller) == CONTROLLER_STARTING)
        s->begun = s->cycles;
    if (!drive_network_end_cycle(&s->network))
        return false;
    follow_tool_point(s);
    watch_correction(s);
    return true;
}
