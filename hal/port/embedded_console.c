#include "port/embedded_console.h"

#include "console/numbers.h"

#include <string.h>

/* Silences say nothing here: no pause is one. */
#define NO_GAP_US UINT32_MAX

/* -- lines, for the service -- */

static void open_lines(void *context, struct source *source)
{
    struct embedded_console *c = context;

    takt_lines_open(&c->lines, source);
}

static void refuse_line(void *context, const struct diagnostic *why)
{
    struct embedded_console *c = context;

    takt_lines_refuse(&c->lines, (uint8_t)takt_console_error_of(why->code), why);
}

static void end_lines(void *context, enum takt_error why)
{
    struct embedded_console *c = context;

    takt_lines_end(&c->lines, why == TAKT_OK ? CONSOLE_OK : CONSOLE_LOCKED, why);
}

struct service_lines takt_embedded_console_get_lines(struct embedded_console *c)
{
    return (struct service_lines){open_lines, refuse_line, end_lines, c};
}

/* -- what the console asks for -- */

static void look(void *context, struct panel_snapshot *snapshot)
{
    const struct embedded_console *c = context;
    const struct panel_port *port = &c->client.panel->config.port;

    port->look(port->context, snapshot);
}

static enum panel_refusal order(void *context, const struct panel_order *wanted)
{
    struct embedded_console *c = context;

    return takt_panel_client_order(&c->client, wanted);
}

static enum panel_refusal unlock(void *context, uint32_t password)
{
    struct embedded_console *c = context;

    return takt_panel_client_unlock(&c->client, password);
}

static bool tell(void *context, enum console_fact fact, double value[AXIS_COUNT])
{
    const struct embedded_console *c = context;
    const struct embedded_port *port = &c->config.embedded->config.port;

    port->lock(port->context);
    takt_service_tell(&c->config.embedded->service, fact, value);
    port->unlock(port->context);
    return true;
}

static void write_answer(void *context, const char *text, size_t length)
{
    const struct embedded_console *c = context;

    c->config.write(c->config.context, text, length);
}

/* -- the line -- */

void takt_embedded_console_init(struct embedded_console *c,
                                const struct embedded_console_config *config)
{
    const struct console_config console = {
        .port = {look, order, unlock, tell, NULL, write_answer, c},
        .machine = &config->embedded->service.controller.machine,
        .lines = &c->lines,
        .version = config->version,
    };

    memset(c, 0, sizeof *c);
    c->config = *config;
    takt_panel_client_enter(&c->client, &config->embedded->config.core->panel);
    takt_line_ring_open(&c->received, NO_GAP_US);
    takt_lines_init(&c->lines, c->text, sizeof c->text);
    takt_console_init(&c->console, &console);
    takt_console_enter(&c->console);
}

void takt_embedded_console_take_byte(struct embedded_console *c, uint8_t byte)
{
    c->has_lost = c->has_lost || !takt_line_ring_put(&c->received, byte, 0);
}

void takt_embedded_console_background(struct embedded_console *c)
{
    bool is_silent;

    if (c->has_lost && takt_line_ring_is_empty(&c->received)) {
        takt_lines_spoil(&c->lines);
        c->has_lost = false;
    }
    while (!takt_line_ring_is_empty(&c->received) && takt_console_has_room(&c->console))
        takt_console_take(&c->console, takt_line_ring_take(&c->received, &is_silent));
    takt_console_step(&c->console);
}
