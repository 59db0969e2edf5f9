#define _POSIX_C_SOURCE 200809L

#include "takt/serving.h"

#include "base/crc32.h"
#include "takt/cutting_feed.h"
#include "takt/interrupt.h"
#include "takt/message.h"
#include "takt/program_front.h"
#include "takt/stopwatch.h"
#include "takt/text.h"

#include <stdlib.h>
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

/* --program, or what has been stored before. */
static enum command_status open_store(struct serving *s)
{
    const struct option_panel *options = &s->session.options->panel;
    const char *path = options->program;

    if (!program_store_open(&s->store, options->store)) {
        message_command_error("--store: the path is too long");
        return STATUS_INPUT;
    }
    if (path == NULL && options->store != NULL && access(options->store, F_OK) == 0)
        path = options->store;
    return path == NULL || load_program(s, path) ? STATUS_DONE : STATUS_INPUT;
}

static void open_service(struct serving *s)
{
    const struct service_config config = {
        .machine = &s->session.setup.machine,
        .can = field_get_port(&s->field),
        .step = field_get_step_port(&s->field),
        .tools = s->session.tools.tools,
        .tools_count = s->session.tools.table.count,
        .reader = &s->reader,
        .parameters = &s->session.parameters.values,
        .correction = s->session.correction,
        .programs = {program_store_read, program_store_adopt, &s->store},
        .plans = plan_queue_get_plans(&s->plan),
        .exact_path = s->session.options->exact_path,
    };

    plan_queue_init(&s->plan, &s->service);
    service_init(&s->service, &config);
    message_controller_warning(&s->service.controller);
    if (s->store.program != NULL)
        service_set_program(&s->service, (uint32_t)s->store.size,
                            crc32_add(CRC32_START, s->store.program, s->store.size));
}

static enum command_status open_field(struct serving *s)
{
    const struct options *options = s->session.options;
    const struct field_options field = {
        .bus = options->bus, .drives = options->drives, .is_paced = true};
    enum command_status status = field_check_options(&field)
                                     ? field_open(&s->field, &s->session.setup, &field)
                                     : STATUS_INPUT;

    s->has_field = status == STATUS_DONE;
    if (status == STATUS_DONE && !bus_log_open(&s->bus_log, options->bus_log))
        status = STATUS_ENVIRONMENT;
    if (status == STATUS_DONE)
        bus_log_observe_field(&s->bus_log, &s->field);
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
        .plans = plan_queue_get_store(&s->plan),
        .password = s->session.setup.panel.password,
    };
    struct server_config config = {.host = panel_host_get(&s->panel)};
    const char *problem = "out of semaphores";

    panel_host_init(&s->panel, &panel);
    s->has_exchange = exchange_open(&s->exchange);
    if (!serving_options_read(&s->options, &s->session, &config))
        return STATUS_INPUT;
    service_look(&s->service, exchange_next_snapshot(&s->exchange));
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
        status = open_store(s);
    if (status == STATUS_DONE)
        status = open_field(s);
    if (status == STATUS_DONE)
        status = open_spindle(s);
    if (status != STATUS_DONE)
        return status;
    cycle_cost_init(&s->cost);
    open_service(s);
    return open_server(s);
}

void serving_close(struct serving *s)
{
    if (s->has_server)
        server_close(&s->server);
    if (s->has_exchange)
        exchange_close(&s->exchange);
    serving_spindle_close(&s->spindle);
    (void)bus_log_close(&s->bus_log);
    if (s->has_field)
        field_close(&s->field);
    program_store_close(&s->store);
    session_close(&s->session);
}

static void step_spindle(struct serving *s)
{
    if (service_take_spindle_reset(&s->service))
        serving_spindle_reset(&s->spindle);
    s->inputs.spindle =
        serving_spindle_cycle(&s->spindle, service_get_outputs(&s->service).spindle_speed_rpm,
                              cutting_feed_mm_s(&s->service.controller));
}

static void update_health(struct serving *s)
{
    const struct cycle_cost *cost = &s->cost;
    const struct service_health health = {
        .bus_load_percent = field_get_load_percent(&s->field),
        .cycle_min_ns = (uint32_t)cost->min_ns,
        .cycle_mean_ns = (uint32_t)(cost->sum_ns / cost->count),
        .cycle_max_ns = (uint32_t)cost->max_ns,
        .overruns = (uint32_t)s->field.pace.overruns,
    };

    service_set_health(&s->service, &health);
}

static void control(struct serving *s)
{
    const uint64_t start_ns = stopwatch_now_ns();

    service_cycle(&s->service, &s->inputs);
    cycle_cost_add(&s->cost, stopwatch_now_ns() - start_ns);
    if (s->cycles++ % HEALTH_CYCLES == 0)
        update_health(s);
}

/* An order is answered when a snapshot shows what came of it. */
static void serve_cycle(struct serving *s)
{
    const struct panel_order *order = exchange_take_order(&s->exchange);
    enum panel_verdict verdict = PANEL_DONE;

    if (order != NULL)
        verdict = service_order(&s->service, order);
    if (exchange_take_alive(&s->exchange))
        service_alive(&s->service);
    service_background(&s->service);
    control(s);
    step_spindle(s);
    service_look(&s->service, exchange_next_snapshot(&s->exchange));
    exchange_publish(&s->exchange);
    if (order != NULL)
        exchange_answer(&s->exchange, verdict);
}

enum command_status serving_run(struct serving *s)
{
    bool good = true;

    if (!server_start(&s->server)) {
        message_command_error("no thread for the panel");
        return STATUS_ENVIRONMENT;
    }
    while (good && !interrupt_asked()) {
        serve_cycle(s);
        bus_log_keep(&s->bus_log);
        good = field_end_cycle(&s->field);
    }
    if (field_get_problem(&s->field) == NULL)
        return bus_log_close(&s->bus_log) ? STATUS_DONE : STATUS_ENVIRONMENT;
    message_command_error("%s", field_get_problem(&s->field));
    return STATUS_ENVIRONMENT;
}
