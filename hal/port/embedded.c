#include "port/embedded.h"

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
    (void)diagnostic_text(&e->refusal, snapshot->alarm_text);
}

/* A snapshot into which a cycle has fallen may be half old: it is taken again. A cycle lasts longer than a look. */
static void look(void *context, struct panel_snapshot *snapshot)
{
    struct embedded *e = context;
    uint32_t before;

    do {
        before = e->cycles;
        service_look(&e->service, snapshot);
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
    verdict = service_order(&e->service, order);
    unlock(e);
    return verdict;
}

static void hear(void *context)
{
    struct embedded *e = context;

    lock(e);
    service_alive(&e->service);
    unlock(e);
}

/* -- the log: what a reader wants to know who was not there -- */

static const char *const state_names[PANEL_STATES] = {
    "starting", "idle", "running",  "MDI",   "jogging",
    "homing",   "held", "stopping", "alarm", "emergency stop",
};

static const char *const outcome_names[] = {"none", "completed", "aborted", "failed"};

static void log_line(const struct embedded *e, const char *text)
{
    e->config.port.log(e->config.port.context, text);
}

static size_t append(char *line, size_t at, const char *text)
{
    while (*text != '\0' && at + 1 < EMBEDDED_LOG_MAX)
        line[at++] = *text++;
    line[at] = '\0';
    return at;
}

static void log_pair(const struct embedded *e, const char *word, const char *text)
{
    char line[EMBEDDED_LOG_MAX];

    (void)append(line, append(line, 0, word), text);
    log_line(e, line);
}

static void log_alarm(const struct embedded *e, const struct diagnostic *alarm)
{
    char text[DIAGNOSTIC_TEXT_MAX];

    (void)diagnostic_text(alarm, text);
    log_pair(e, "alarm: ", text);
}

/* "completed, setpoints 0123456789abcdef" */
static void log_outcome(const struct embedded *e)
{
    static const char digits[] = "0123456789abcdef";
    char digest[17];
    char line[EMBEDDED_LOG_MAX];
    size_t at = append(line, 0, outcome_names[e->service.outcome]);

    for (unsigned i = 0; i < 16; i++)
        digest[i] = digits[e->service.digest >> (60 - 4 * i) & 15U];
    digest[16] = '\0';
    at = append(line, at, ", setpoints ");
    (void)append(line, at, digest);
    log_line(e, line);
}

static void log_changes(struct embedded *e)
{
    const enum panel_state state = service_get_state(&e->service);

    if (e->service.runs != e->logged_runs)
        log_outcome(e);
    e->logged_runs = e->service.runs;
    if (e->service.alarm != e->logged_alarm && e->service.alarm != PANEL_ALARM_NONE)
        log_alarm(e, &e->service.alarm_text);
    e->logged_alarm = e->service.alarm;
    if (state != e->logged_state)
        log_pair(e, "state: ", state_names[state]);
    e->logged_state = state;
}

/* -- start -- */

static void init_service(struct embedded *e)
{
    const struct embedded_config *config = &e->config;
    const struct service_config service = {
        .machine = config->machine,
        .step = config->step,
        .can = config->can,
        .tools = config->tools,
        .tools_count = config->tools_count,
        .reader = &e->config.core->reader,
        .parameters = &e->config.core->parameters,
        .correction = config->correction,
        .programs = {text_queue_open, text_queue_adopt, &e->config.core->queue},
        .plans = plan_queue_get_plans(&e->config.core->plan),
    };

    parameters_clear(&e->config.core->parameters);
    service_init(&e->service, &service);
}

static void init_panel(struct embedded *e)
{
    const struct panel_config panel = {
        .port = {.look = look, .order = order, .alive = hear, .context = e},
        .store = text_queue_get_store(&e->config.core->queue),
        .settings = e->config.settings,
        .plans = plan_queue_get_store(&e->config.core->plan),
        .password = e->config.password,
    };
    struct modbus_map map;

    panel_init(&e->config.core->panel, &panel);
    panel_client_enter(&e->config.core->client, &e->config.core->panel);
    map = panel_client_map(&e->config.core->client);
    modbus_rtu_init(&e->config.core->rtu, &map, e->config.unit, e->config.gap_us);
}

void embedded_init(struct embedded *e, const struct embedded_config *config)
{
    memset(e, 0, sizeof *e);
    e->config = *config;
    e->cycle_min_ns = UINT32_MAX;
    e->logged_state = PANEL_STATES;
    text_queue_init(&e->config.core->queue);
    plan_queue_init(&e->config.core->plan, &e->service);
    init_service(e);
    init_panel(e);
    e->config.port.log(e->config.port.context, config->name);
}

void embedded_refuse(struct embedded *e, const struct diagnostic *why)
{
    if (e->refused)
        return;
    e->refusal = *why;
    e->refused = true;
    log_alarm(e, why);
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

void embedded_cycle(struct embedded *e, const struct inputs *inputs, bool late)
{
    const struct embedded_port *port = &e->config.port;
    const uint32_t start_ns = port->now_ns(port->context);

    if (e->refused)
        return;
    service_cycle(&e->service, inputs);
    e->cycles++;
    e->overruns += late;
    measure(e, port->now_ns(port->context) - start_ns);
}

struct outputs embedded_get_outputs(const struct embedded *e)
{
    return service_get_outputs(&e->service);
}

/* -- the background -- */

void embedded_take_byte(struct embedded *e, uint8_t byte, uint32_t now_us)
{
    (void)line_ring_put(&e->received, byte, now_us);
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
    service_set_health(&e->service, &health);
}

/* A clock of several interrupts may step back by a little; a line whose time did would be taken for long silent. */
static uint32_t forward(struct embedded *e, uint32_t time_us)
{
    if ((int32_t)(time_us - e->line_us) > 0)
        e->line_us = time_us;
    return e->line_us;
}

/* What has come on the panel's line, and the silence after it. */
static void serve_line(struct embedded *e)
{
    const struct embedded_port *port = &e->config.port;
    uint8_t reply[MODBUS_RTU_MAX];
    uint32_t came_us;
    size_t length;

    while (!line_ring_is_empty(&e->received)) {
        const uint8_t byte = line_ring_take(&e->received, port->now_us(port->context), &came_us);

        text_queue_use(&e->config.core->queue, e->service.job != SERVICE_NOTHING);
        length = modbus_rtu_take(&e->config.core->rtu, byte, forward(e, came_us), reply);
        if (length > 0)
            port->reply(port->context, reply, length);
    }
    length = modbus_rtu_idle(&e->config.core->rtu, forward(e, port->now_us(port->context)), reply);
    if (length > 0)
        port->reply(port->context, reply, length);
}

void embedded_background(struct embedded *e)
{
    update_health(e);
    serve_line(e);
    if (e->refused)
        return;
    service_background(&e->service);
    log_changes(e);
}
