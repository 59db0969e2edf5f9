#include "serving/serving_console.h"

#include "cli/message.h"
#include "cli/options.h"
#include "console/numbers.h"
#include "serving/serving.h"

#include <stdio.h>
#include <string.h>

/* ---- lines, called by the control thread ---- */

static void open_lines(void *context, struct source *source)
{
    struct serving *s = context;

    takt_lines_open(&s->console.server.lines, source);
}

static void refuse_line(void *context, const struct diagnostic *why)
{
    struct serving *s = context;

    takt_lines_refuse(&s->console.server.lines, (uint8_t)takt_console_error_of(why->code), why);
}

static void end_lines(void *context, enum takt_error why)
{
    struct serving *s = context;

    takt_lines_end(&s->console.server.lines, why == TAKT_OK ? CONSOLE_OK : CONSOLE_LOCKED, why);
}

struct service_lines serving_console_get_lines(struct serving *s)
{
    return (struct service_lines){open_lines, refuse_line, end_lines, s};
}

/* ---- what the console asks for, in its thread ---- */

static void look(void *context, struct panel_snapshot *snapshot)
{
    struct serving *s = context;

    panel_host_look(&s->panel, snapshot);
}

static enum panel_refusal order(void *context, const struct panel_order *wanted)
{
    struct serving *s = context;

    return panel_host_order(&s->panel, wanted);
}

static enum panel_refusal unlock(void *context, uint32_t password)
{
    struct serving *s = context;

    return panel_host_give_password(&s->panel, password);
}

/* By the control thread, while the console's waits. */
static bool ask(struct serving *s, void (*task)(void *context), void *context)
{
    bool is_done;

    panel_host_lock(&s->panel);
    is_done = exchange_ask(&s->exchange, task, context);
    panel_host_unlock(&s->panel);
    return is_done;
}

struct question {
    const struct service *service;
    enum console_fact fact;
    double value[AXIS_COUNT];
};

static void answer(void *context)
{
    struct question *q = context;

    takt_service_tell(q->service, q->fact, q->value);
}

static bool tell(void *context, enum console_fact fact, double value[AXIS_COUNT])
{
    struct serving *s = context;
    struct question question = {.service = &s->service, .fact = fact};
    const bool is_told = ask(s, answer, &question);

    memcpy(value, question.value, sizeof question.value);
    return is_told;
}

/* ---- $C ---- */

static void copy_parameters(void *context)
{
    struct serving *s = context;

    s->console.check.parameters = *s->service.config.parameters;
}

/* One line, and nothing behind it yet. */
static long read_line(void *context, char *buffer, size_t size)
{
    struct serving_check *c = context;
    size_t count = c->text.length - c->text.position;

    if (count == 0)
        return SOURCE_LATER;
    count = count < size ? count : size;
    memcpy(buffer, c->text.text + c->text.position, count);
    c->text.position += count;
    return (long)count;
}

static void begin_check(struct serving *s)
{
    struct serving_check *c = &s->console.check;
    const struct controller_config controller = {.machine = &s->session.setup.machine,
                                                 .tools = &s->service.tools,
                                                 .parameters = &c->parameters,
                                                 .exact_path = s->session.options->exact_path};
    const struct source source = {.read = read_line, .context = c};
    struct program_config config;

    takt_controller_program_config(&controller, &config);
    config.waits = false;
    takt_program_open(&c->program, &config, &source);
    takt_cutter_compensation_open(&c->offset, &config);
}

/* TAKT_OK: the line is right, or it ends the program, and the next one begins another. */
static enum takt_error read_moves(struct serving *s)
{
    struct serving_check *c = &s->console.check;
    enum takt_error error = TAKT_OK;
    struct diagnostic diagnostic;
    enum program_result result;
    struct move move;

    do {
        result = takt_cutter_compensation_next(&c->offset, &c->program, &move, &diagnostic);
        if (result == PROGRAM_ERROR)
            error = diagnostic.code;
    } while (result == PROGRAM_MOVE || result == PROGRAM_ERROR);
    if (result == PROGRAM_END)
        begin_check(s);
    return error;
}

static enum takt_error check(void *context, const char *line, bool begins)
{
    struct serving *s = context;
    struct serving_check *c = &s->console.check;
    char text[LINES_LENGTH_MAX + 2];
    const int length = snprintf(text, sizeof text, "%s\n", line);

    if (begins) {
        (void)ask(s, copy_parameters, s);
        begin_check(s);
    }
    c->text = (struct source_text){text, (size_t)length, 0};
    return read_moves(s);
}

/* ---- open and close ---- */

static void enter(void *context)
{
    struct serving *s = context;

    panel_host_enter_console(&s->panel);
}

static void leave(void *context)
{
    struct serving *s = context;

    panel_host_leave_console(&s->panel);
}

enum command_status serving_console_open(struct serving *s)
{
    struct console_server_config config = {
        .console = {.port = {look, order, unlock, tell, check, NULL, s},
                    .machine = &s->session.setup.machine,
                    .version = TAKT_VERSION},
        .enter = enter,
        .leave = leave,
        .context = s,
    };
    const char *problem;

    if (s->session.options->panel.grbl == NULL)
        return STATUS_DONE;
    if (!serving_options_read_console(&s->options, &s->session, &config))
        return STATUS_INPUT;
    s->console.is_open = true;
    enter(s);
    if (console_server_open(&s->console.server, &config, &problem))
        return STATUS_DONE;
    message_command_error("--grbl %s: %s", s->session.options->panel.grbl, problem);
    return STATUS_ENVIRONMENT;
}

bool serving_console_start(struct serving *s)
{
    return !s->console.is_open || console_server_start(&s->console.server);
}

void serving_console_close(struct serving *s)
{
    if (s->console.is_open)
        console_server_close(&s->console.server);
    s->console.is_open = false;
}

void serving_console_print(const struct serving *s)
{
    const struct console_server *server = &s->console.server;

    if (!s->console.is_open)
        return;
    if (server->config.address != NULL)
        (void)printf("Grbl console on %s:%u\n", server->config.address,
                     (unsigned)console_server_get_port(server));
    else
        (void)printf("Grbl console on %s\n", server->config.link);
}
