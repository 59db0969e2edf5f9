/* takt view: play a trace back in the browser. */
#include "cli/interrupt.h"
#include "cli/message.h"
#include "cli/text.h"
#include "serve/exchange.h"
#include "serving/serving_options.h"
#include "serving/serving_page.h"
#include "serving/viewing.h"
#include "session/session.h"
#include "simulation/pace.h"
#include "takt/command.h"

#include <stdio.h>
#include <stdlib.h>

#define NS_PER_S      1e9
#define SPEED_DEFAULT 1.0

/* It must not be moved once opened. */
struct view {
    struct session session;
    struct serving_options options;
    struct viewing viewing;
    struct exchange exchange;
    struct panel_host panel;
    struct page_link link;
    struct page_setup setup;
    struct page_server *server;
    struct text program; /* what the second operand says; empty without one */
};

/* ---- for pages ---- */

static bool get_program(void *context, const char **text, size_t *size)
{
    const struct view *view = context;

    *text = view->program.bytes != NULL ? view->program.bytes : "";
    *size = view->program.length;
    return true;
}

/* Where the trace goes; feed and rapid moves look alike in it. */
static void draw(void *context, const struct page_source *source, struct page_path *path)
{
    const struct viewing *v = &((const struct view *)context)->viewing;

    (void)source;
    for (size_t i = 0; i < v->count; i++) {
        if (!page_path_add(path, &v->row[i].set, v->row[i].line, false))
            return;
    }
}

/* Nothing is taken here. */
static bool begin_nothing(void *context, uint32_t size)
{
    (void)context;
    (void)size;
    return false;
}

/* ---- a cycle ---- */

static void do_job(struct page_link *link)
{
    struct page_job *job = page_link_get_job(link);

    if (job == NULL)
        return;
    job->tools_count = 0;
    page_link_finish(link);
}

static void play_cycle(struct view *view)
{
    const struct panel_order *order = exchange_take_order(&view->exchange);
    enum panel_verdict verdict = PANEL_DONE;

    if (order != NULL)
        verdict = viewing_order(&view->viewing, order);
    viewing_cycle(&view->viewing, &view->link);
    viewing_look(&view->viewing, exchange_next_snapshot(&view->exchange));
    exchange_publish(&view->exchange);
    do_job(&view->link);
    if (order != NULL)
        exchange_answer(&view->exchange, verdict);
}

static void play(struct view *view)
{
    struct pace pace = {0};

    pace_start(&pace, (uint64_t)(view->viewing.cycle_s * NS_PER_S));
    while (!interrupt_asked()) {
        play_cycle(view);
        (void)pace_end_work(&pace);
        pace_sleep(&pace);
        pace_begin_cycle(&pace);
    }
}

/* ---- open and close ---- */

static enum command_status serve(struct view *view)
{
    const struct panel_config panel = {.port = exchange_get_port(&view->exchange),
                                       .store = {.begin = begin_nothing},
                                       .password = view->session.setup.panel.password};
    struct page_server_config config = {.panel = &view->panel,
                                        .link = &view->link,
                                        .setup = &view->setup,
                                        .owner = {get_program, draw, view}};
    const char *problem = "--http off";

    panel_host_init(&view->panel, &panel);
    serving_page_set_up(&view->setup, &view->session.setup.machine);
    view->setup.cycle_us = (uint32_t)(view->viewing.cycle_s * 1e6 + 0.5);
    viewing_look(&view->viewing, exchange_next_snapshot(&view->exchange));
    exchange_publish(&view->exchange);
    if (!serving_options_read_page(&view->options, &view->session, &config))
        return STATUS_INPUT;
    if (config.address != NULL)
        view->server = page_server_open(&config, &problem);
    if (view->server != NULL)
        return STATUS_DONE;
    message_command_error("no page: %s", problem);
    return STATUS_ENVIRONMENT;
}

static enum command_status open_view(struct view *view, const struct options *options)
{
    const double speed = options->speed > 0 ? options->speed : SPEED_DEFAULT;

    if (session_open_machine(&view->session, options) != STATUS_DONE ||
        !viewing_open(&view->viewing, options->operand[0], &view->session.setup.machine, speed))
        return STATUS_INPUT;
    if (options->operands > 1 && !text_read(&view->program, options->operand[1]))
        return STATUS_INPUT;
    if (exchange_open(&view->exchange))
        return serve(view);
    message_command_error("out of semaphores");
    return STATUS_ENVIRONMENT;
}

static void close_view(struct view *view)
{
    page_server_close(view->server);
    viewing_close(&view->viewing);
    text_free(&view->program);
    session_close(&view->session);
    free(view);
}

static enum command_status command_view_execute(const struct options *options)
{
    struct view *view = calloc(1, sizeof *view);
    enum command_status status;

    if (view == NULL) {
        message_command_error("out of memory");
        return STATUS_ENVIRONMENT;
    }
    status = open_view(view, options);
    if (status == STATUS_DONE) {
        serving_page_print(view->options.http, view->server);
        play(view);
    }
    close_view(view);
    return status;
}

static const struct option_row rows[] = {
    OPTIONS_MACHINE,
    {"http", OPTION_TEXT, offsetof(struct options, panel.http), "HOST:PORT",
     "where the page is (default 127.0.0.1:8080; port 0: any)"},
    {"insecure", OPTION_FLAG, offsetof(struct options, panel.insecure), NULL,
     "listen beyond this computer though neither panel.allow nor panel.password is set"},
    {"speed", OPTION_POSITIVE, offsetof(struct options, speed), "N",
     "so many times as fast as it was (default 1)"},
    OPTIONS_END,
};

const struct command command_view = {
    .name = "view",
    .usage = "TRACE [PROGRAM] [options]",
    .summary = "play a trace back in the browser",
    .help =
        "The page of `takt serve` shows what the trace of a run says, in time or faster: the way, "
        "the axes beside the\n"
        "machine's limits, the active line of PROGRAM. Start, hold, resume, reset, a start line "
        "and "
        "the feed override\n"
        "count for the playing. Ctrl-C ends it.\n"
        "\n"
        "Examples:\n"
        "  takt run part.ngc --trace part.csv && takt view part.csv part.ngc\n"
        "  takt run part.ngc --plan ahead --trace part.csv && takt view part.csv --speed "
        "10\n",
    .options = rows,
    .operands_min = 1,
    .operands_max = 2,
    .run = command_view_execute,
};
