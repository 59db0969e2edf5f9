#define _POSIX_C_SOURCE 200809L

#include "serving/serving.h"

#include "base/crc32.h"
#include "cli/message.h"
#include "cli/output_file.h"
#include "cli/stopwatch.h"
#include "cli/text.h"
#include "config/shaper.h"
#include "session/program_front.h"
#include "simulation/cutting_feed.h"
#include "simulation/drives_table.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Cycles between two updates of the figures about speed. */
#define HEALTH_CYCLES 64

static bool load_program(struct serving *s, const char *path)
{
    const struct program_front front = {.dialect = DIALECT_AUTO, .codes = &s->session.setup.codes};
    struct text text;
    bool good;

    if (!program_front_read(&front, path, &text))
        return false;
    good = text.length <= PANEL_PROGRAM_BYTES_MAX;
    if (!good) {
        message_error(path, 0, 0, "the program is longer than %d bytes", PANEL_PROGRAM_BYTES_MAX);
    } else if (!program_store_set(&s->store, text.bytes, text.length)) {
        message_command_error("out of memory");
        good = false;
    }
    text_free(&text);
    return good;
}

/* Else each program that is brought would be refused, whoever brings it. */
static enum command_status check_store(struct serving *s, const char *path)
{
    const char *program = s->session.options->panel.program;
    const bool is_program = path != NULL && program != NULL && strcmp(path, program) == 0;

    if (path != NULL && !is_program && !output_file_may_write(path))
        return STATUS_INPUT;
    if (program_store_can_keep(&s->store))
        return STATUS_DONE;
    message_command_error("--store %s: programs cannot be kept there: %s", path, strerror(errno));
    return STATUS_ENVIRONMENT;
}

/* --program, or what has been stored before. */
static enum command_status open_store(struct serving *s)
{
    const struct option_panel *options = &s->session.options->panel;
    const char *path = options->program;
    const char *store =
        options->store != NULL ? options->store : serving_state_get_program(&s->state);
    enum command_status status;

    if (!program_store_open(&s->store, store)) {
        message_command_error("--store: the path is too long");
        return STATUS_INPUT;
    }
    status = check_store(s, store);
    if (status != STATUS_DONE)
        return status;
    if (path == NULL && store != NULL && access(store, F_OK) == 0)
        path = store;
    return path == NULL || load_program(s, path) ? STATUS_DONE : STATUS_INPUT;
}

static void open_service(struct serving *s)
{
    const struct service_config config = {
        .machine = &s->session.setup.machine,
        .can = drive_network_get_port(&s->network),
        .dcf = s->session.configurations.dcf,
        .step = drive_network_get_step_port(&s->network),
        .tools = s->session.tools.tools,
        .tools_count = s->session.tools.table.count,
        .reader = &s->reader,
        .parameters = &s->session.parameters.values,
        .correction = s->session.correction,
        .shape = shaper_prepare(&s->session.setup, &s->shape),
        .programs = {program_store_read, program_store_adopt, &s->store},
        .plans = takt_plan_queue_get_plans(&s->plan),
        .lines = serving_console_get_lines(s),
        .exact_path = s->session.options->exact_path,
    };
    const char *text;
    size_t size;

    takt_plan_queue_init(&s->plan, &s->service);
    takt_service_init(&s->service, &config);
    drive_network_watch_drives(&s->network, takt_controller_get_drives(&s->service.controller));
    message_controller_warning(&s->service.controller);
    if (program_store_get(&s->store, &text, &size))
        takt_service_set_program(&s->service, (uint32_t)size,
                                 takt_crc32_add(CRC32_START, text, size));
    takt_service_set_start_line(&s->service, s->session.options->from_line);
    serving_state_restore(&s->state, &s->service);
    s->has_service = true;
}

static enum command_status open_network(struct serving *s)
{
    const struct options *options = s->session.options;
    const struct drive_network_options network = {.bus = options->bus,
                                                  .drives = options->drives,
                                                  .drive_image = options->drive_image,
                                                  .is_paced = true,
                                                  .returns = true};
    enum command_status status = drive_network_check_options(&network)
                                     ? drive_network_open(&s->network, &s->session.setup, &network)
                                     : STATUS_INPUT;

    s->has_field = status == STATUS_DONE;
    if (status == STATUS_DONE && !bus_log_open(&s->bus_log, options->bus_log))
        status = STATUS_ENVIRONMENT;
    if (status == STATUS_DONE)
        bus_log_observe_network(&s->bus_log, &s->network);
    return status;
}

static enum command_status open_spindle(struct serving *s)
{
    const char *where = s->session.options->panel.spindle;

    s->inputs = inputs_idle();
    if (where != NULL)
        s->session.setup.machine.spindle_encoder_counts = 0; /* its registers tell no angle */
    return serving_spindle_open(&s->spindle, &s->session.setup, where, 1) ? STATUS_DONE
                                                                          : STATUS_INPUT;
}

static enum command_status open_server(struct serving *s)
{
    const struct panel_config panel = {
        .port = exchange_get_port(&s->exchange),
        .store = program_store_get_staging(&s->store),
        .plans = takt_plan_queue_get_store(&s->plan),
        .password = s->session.setup.panel.password,
    };
    struct server_config config = {.host = panel_host_get(&s->panel)};
    const char *problem = "out of semaphores";

    panel_host_init(&s->panel, &panel);
    s->has_exchange = exchange_open(&s->exchange);
    if (!serving_options_read(&s->options, &s->session, &config))
        return STATUS_INPUT;
    takt_service_look(&s->service, exchange_next_snapshot(&s->exchange));
    exchange_publish(&s->exchange);
    s->has_server = s->has_exchange;
    if (s->has_server && server_open(&s->server, &config, &problem))
        return STATUS_DONE;
    message_command_error("%s:%s: %s", config.address, config.port, problem);
    return STATUS_ENVIRONMENT;
}

enum command_status serving_open(struct serving *s, const struct options *options)
{
    enum command_status status = session_open_machine(&s->session, options);

    if (status == STATUS_DONE)
        status = serving_state_open(&s->state, &s->session);
    if (status == STATUS_DONE)
        status = open_store(s);
    if (status == STATUS_DONE)
        status = open_network(s);
    if (status == STATUS_DONE)
        status = open_spindle(s);
    if (status != STATUS_DONE)
        return status;
    cycle_cost_init(&s->cost);
    open_service(s);
    status = open_server(s);
    if (status == STATUS_DONE)
        status = serving_page_open(s);
    if (status == STATUS_DONE)
        status = serving_console_open(s);
    return status == STATUS_DONE ? serving_state_start(&s->state) : status;
}

void serving_close(struct serving *s)
{
    serving_console_close(s);
    serving_page_close(s);
    if (s->has_server)
        server_close(&s->server);
    if (s->has_exchange)
        exchange_close(&s->exchange);
    (void)serving_state_close(&s->state, s->has_service ? &s->service : NULL);
    serving_spindle_close(&s->spindle);
    (void)bus_log_close(&s->bus_log);
    if (s->has_field)
        drive_network_close(&s->network);
    program_store_close(&s->store);
    session_close(&s->session);
}

static void step_spindle(struct serving *s)
{
    if (takt_service_take_spindle_reset(&s->service))
        serving_spindle_reset(&s->spindle);
    s->inputs.spindle =
        serving_spindle_cycle(&s->spindle, takt_service_get_outputs(&s->service).spindle_speed_rpm,
                              cutting_feed_mm_s(&s->service.controller));
}

static void update_health(struct serving *s)
{
    const struct cycle_cost *cost = &s->cost;
    const struct service_health health = {
        .bus_load_percent = drive_network_get_highest_load_percent(&s->network),
        .cycle_min_ns = (uint32_t)cost->min_ns,
        .cycle_mean_ns = (uint32_t)(cost->sum_ns / cost->count),
        .cycle_max_ns = (uint32_t)cost->max_ns,
        .overruns = (uint32_t)s->network.pace.overruns,
    };

    takt_service_set_health(&s->service, &health);
}

static void control(struct serving *s)
{
    const uint64_t start_ns = stopwatch_now_ns();

    takt_service_cycle(&s->service, &s->inputs);
    cycle_cost_add(&s->cost, stopwatch_now_ns() - start_ns);
    if (s->cycles++ % HEALTH_CYCLES == 0)
        update_health(s);
}

/* Once, when the drives are enabled: what they do without. */
static void tell_drives(struct serving *s)
{
    if (!s->has_told_drives)
        s->has_told_drives = drives_table_tell(takt_controller_get_drives(&s->service.controller),
                                               s->session.options->quiet);
}

/* Once it ends nothing is begun any more, only stopped. */
static enum panel_verdict give_order(struct serving *s, const struct panel_order *order)
{
    return s->ending.way == ENDING_NOT || takt_panel_is_for_everybody(order)
               ? takt_service_order(&s->service, order)
               : PANEL_WRONG_STATE;
}

/* An order is answered when a snapshot shows what came of it. */
static void serve_cycle(struct serving *s)
{
    const struct panel_order *order = exchange_take_order(&s->exchange);
    enum panel_verdict verdict = PANEL_DONE;

    if (order != NULL)
        verdict = give_order(s, order);
    if (exchange_take_alive(&s->exchange))
        takt_service_alive(&s->service);
    takt_service_background(&s->service);
    control(s);
    step_spindle(s);
    tell_drives(s);
    takt_service_look(&s->service, exchange_next_snapshot(&s->exchange));
    exchange_publish(&s->exchange);
    serving_page_cycle(s);
    if (order != NULL)
        exchange_answer(&s->exchange, verdict);
}

/* A log that has been asked for and cannot be kept ends the service, in order. */
static void look_for_end(struct serving *s)
{
    struct controller *controller = &s->service.controller;

    if (bus_log_has_failed(&s->bus_log))
        ending_ask(&s->ending, controller, ENDING_ON_PATH);
    ending_ask(&s->ending, controller, ending_by_signals());
}

/* Drives on a bus that is gone cannot be told anything; they have stopped by themselves. */
static bool has_ended(struct serving *s)
{
    if (s->ending.way == ENDING_NOT ||
        !(drive_network_is_lost(&s->network) || ending_is_over(&s->ending, &s->service.controller)))
        return false;
    return serving_spindle_stop(&s->spindle);
}

static enum command_status how_it_ended(struct serving *s)
{
    const bool is_kept = serving_state_close(&s->state, &s->service);

    if (!bus_log_close(&s->bus_log) || !is_kept)
        return STATUS_ENVIRONMENT;
    return s->ending.way == ENDING_AT_ONCE ? STATUS_INTERRUPTED : STATUS_DONE;
}

enum command_status serving_run(struct serving *s)
{
    if (!server_start(&s->server) || !serving_console_start(s)) {
        message_command_error("no thread for the panel");
        return STATUS_ENVIRONMENT;
    }
    s->ending.stays_on = s->session.setup.drives_stay_on != 0;
    while (!has_ended(s)) {
        serve_cycle(s);
        bus_log_keep(&s->bus_log);
        serving_state_keep(&s->state, &s->service, link_clock_ns());
        (void)drive_network_end_cycle(&s->network);
        if (drive_network_is_lost(&s->network))
            takt_service_lose_bus(&s->service, drive_network_get_lost_bus(&s->network));
        look_for_end(s);
    }
    return how_it_ended(s);
}
