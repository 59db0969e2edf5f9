#include "port/embedded.h"

#include "port/embedded_log.h"

#include <string.h>

#define NS_PER_US 1000

/* -- the panel's way to the service -- */

static void lock(const struct embedded *e)
{
    e->config.port.lock(e->config.port.context);
}

static void unlock(const struct embedded *e)
{
    e->config.port.unlock(e->config.port.context);
}

/* A machine that must not run looks like one in alarm that no order leads out of. */
static void look_at_refusal(const struct embedded *e, struct panel_snapshot *snapshot)
{
    snapshot->value[REGISTER_STATE] = PANEL_ALARM;
    snapshot->value[REGISTER_ALARM] = PANEL_ALARM_INTERNAL;
    snapshot->value[REGISTER_ALARM_LINE] = 0;
    (void)takt_diagnostic_text(&e->refusal, snapshot->alarm_text);
}

/*
 * A snapshot into which a cycle has fallen may be half old: it is taken again. A cycle lasts longer
 * than a look.
 */
static void look(void *context, struct panel_snapshot *snapshot)
{
    struct embedded *e = context;
    uint32_t before;

    do {
        before = e->cycles;
        takt_service_look(&e->service, snapshot);
    } while (before != e->cycles);
    if (e->refused)
        look_at_refusal(e, snapshot);
}

static enum panel_verdict order(void *context, const struct panel_order *order)
{
    struct embedded *e = context;
    enum panel_verdict verdict;

    if (e->refused)
        return PANEL_WRONG_STATE;
    lock(e);
    verdict = takt_service_order(&e->service, order);
    unlock(e);
    return verdict;
}

static void hear(void *context)
{
    struct embedded *e = context;

    lock(e);
    takt_service_alive(&e->service);
    unlock(e);
}

/* -- start -- */

static void init_service(struct embedded *e)
{
    const struct embedded_config *config = &e->config;
    struct service_config service = {
        .machine = config->machine,
        .step = config->step,
        .can = config->can,
        .tools = config->tools,
        .tools_count = config->tools_count,
        .reader = &e->config.core->reader,
        .parameters = &e->config.core->parameters,
        .correction = config->correction,
        .dcf = config->dcf,
        .programs = {takt_text_queue_open, takt_text_queue_adopt, &e->config.core->queue},
        .plans = takt_plan_queue_get_plans(&e->config.core->plan),
    };

    if (config->lines != NULL)
        service.lines = *config->lines;
    takt_parameters_clear(&e->config.core->parameters);
    takt_service_init(&e->service, &service);
}

static void init_panel(struct embedded *e)
{
    const struct panel_config panel = {
        .port = {.look = look, .order = order, .alive = hear, .context = e},
        .store = takt_text_queue_get_store(&e->config.core->queue),
        .settings = e->config.settings,
        .plans = takt_plan_queue_get_store(&e->config.core->plan),
        .password = e->config.password,
    };
    struct modbus_map map;

    takt_panel_init(&e->config.core->panel, &panel);
    takt_panel_client_enter(&e->config.core->client, &e->config.core->panel);
    map = takt_panel_client_map(&e->config.core->client);
    takt_modbus_rtu_init(&e->config.core->rtu, &map, e->config.unit, e->config.gap_us);
}

void takt_embedded_init(struct embedded *e, const struct embedded_config *config)
{
    memset(e, 0, sizeof *e);
    e->config = *config;
    e->cycle_min_ns = UINT32_MAX;
    e->logged_state = PANEL_STATES;
    takt_line_ring_open(&e->received, config->gap_us);
    takt_text_queue_init(&e->config.core->queue);
    takt_plan_queue_init(&e->config.core->plan, &e->service);
    init_service(e);
    init_panel(e);
    takt_embedded_log_line(e, config->name);
}

void takt_embedded_refuse(struct embedded *e, const struct diagnostic *why)
{
    if (e->refused)
        return;
    e->refusal = *why;
    e->refused = true;
    takt_embedded_log_alarm(e, why);
}

/* -- the control cycle -- */

static void measure(struct embedded *e, uint32_t duration_ns)
{
    if (duration_ns < e->cycle_min_ns)
        e->cycle_min_ns = duration_ns;
    if (duration_ns > e->cycle_max_ns)
        e->cycle_max_ns = duration_ns;
    e->cycle_sum_ns += duration_ns;
}

void takt_embedded_cycle(struct embedded *e, const struct inputs *inputs, bool late)
{
    const struct embedded_port *port = &e->config.port;
    const uint32_t start_ns = port->now_ns(port->context);

    if (e->refused)
        return;
    takt_service_cycle(&e->service, inputs);
    e->cycles++;
    e->overruns += late;
    measure(e, port->now_ns(port->context) - start_ns);
}

struct outputs takt_embedded_get_outputs(const struct embedded *e)
{
    return takt_service_get_outputs(&e->service);
}

/* -- the background -- */

void takt_embedded_take_byte(struct embedded *e, uint8_t byte, uint32_t now_us)
{
    (void)takt_line_ring_put(&e->received, byte, now_us);
}

/* Nothing of the service's health is read by the cycle. */
static void update_health(struct embedded *e)
{
    struct service_health health;

    lock(e);
    health = (struct service_health){
        .cycle_min_ns = e->cycle_min_ns,
        .cycle_mean_ns = e->cycles > 0 ? (uint32_t)(e->cycle_sum_ns / e->cycles) : 0,
        .cycle_max_ns = e->cycle_max_ns,
        .overruns = e->overruns,
    };
    unlock(e);
    takt_service_set_health(&e->service, &health);
}

/* The line's own time: that of its silences. */
static uint32_t pass_silence(struct embedded *e, bool is_one)
{
    e->line_us += is_one ? e->config.gap_us : 0;
    return e->line_us;
}

static void send_reply(const struct embedded *e, const uint8_t *reply, size_t length)
{
    if (length > 0)
        e->config.port.reply(e->config.port.context, reply, length);
}

/* What has come on the panel's line, and the silence after it. */
static void serve_line(struct embedded *e)
{
    const struct embedded_port *port = &e->config.port;
    struct modbus_rtu *rtu = &e->config.core->rtu;
    uint8_t reply[MODBUS_RTU_MAX];
    bool is_silent;

    while (!takt_line_ring_is_empty(&e->received)) {
        const uint8_t byte = takt_line_ring_take(&e->received, &is_silent);

        takt_text_queue_use(&e->config.core->queue, e->service.job != SERVICE_NOTHING);
        send_reply(e, reply, takt_modbus_rtu_take(rtu, byte, pass_silence(e, is_silent), reply));
    }
    is_silent = takt_line_ring_is_silent(&e->received, port->now_us(port->context));
    send_reply(e, reply, takt_modbus_rtu_idle(rtu, pass_silence(e, is_silent), reply));
}

void takt_embedded_background(struct embedded *e)
{
    update_health(e);
    serve_line(e);
    if (e->refused)
        return;
    takt_service_background(&e->service);
    takt_embedded_log_changes(e);
}
