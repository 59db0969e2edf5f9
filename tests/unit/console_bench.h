/*
 * What the tests of the console share: a console as a client of the panel of a service on three
 * virtual drives, in virtual time.
 */
#ifndef TAKT_TESTS_CONSOLE_BENCH_H
#define TAKT_TESTS_CONSOLE_BENCH_H

#include "console/console.h"
#include "console/numbers.h"
#include "panel/panel.h"
#include "service_verifier.h"

#include <stdlib.h>

#define CONSOLE_TEXT 2048
#define SAID_MAX     262144

static struct console console;
static struct lines lines;
static uint8_t console_text[CONSOLE_TEXT];
static struct panel panel;
static struct panel_client sender, other;
static char said[SAID_MAX]; /* since the last forget */
static size_t said_length;

static void look_panel(void *context, struct panel_snapshot *snapshot)
{
    (void)context;
    takt_service_look(&service, snapshot);
}

static enum panel_verdict order_service(void *context, const struct panel_order *wanted)
{
    (void)context;
    return takt_service_order(&service, wanted);
}

static void hear_panel(void *context)
{
    (void)context;
    takt_service_alive(&service);
}

static enum panel_refusal order_panel(void *context, const struct panel_order *wanted)
{
    (void)context;
    return takt_panel_client_order(&sender, wanted);
}

static enum panel_refusal unlock_panel(void *context, uint32_t password)
{
    (void)context;
    return takt_panel_client_unlock(&sender, password);
}

static bool tell_service(void *context, enum console_fact fact, double value[AXIS_COUNT])
{
    (void)context;
    takt_service_tell(&service, fact, value);
    return true;
}

static void hear(void *context, const char *text, size_t length)
{
    (void)context;
    TEST_ASSERT_TRUE(said_length + length < SAID_MAX);
    memcpy(said + said_length, text, length);
    said_length += length;
    said[said_length] = '\0';
}

static void open_lines(void *context, struct source *source)
{
    (void)context;
    takt_lines_open(&lines, source);
}

static void refuse_line(void *context, const struct diagnostic *why)
{
    (void)context;
    takt_lines_refuse(&lines, (uint8_t)takt_console_error_of(why->code), why);
}

static void end_lines(void *context, enum takt_error why)
{
    (void)context;
    takt_lines_end(&lines, why == TAKT_OK ? CONSOLE_OK : CONSOLE_LOCKED, why);
}

static void forget(void)
{
    said_length = 0;
    said[0] = '\0';
}

static void console_bench_set_up(uint32_t password)
{
    const struct panel_config config = {
        .port = {.look = look_panel, .order = order_service, .alive = hear_panel},
        .password = password,
    };
    const struct console_config console_config = {
        .port = {look_panel, order_panel, unlock_panel, tell_service, NULL, hear, NULL},
        .machine = &machine,
        .lines = &lines,
        .version = "test",
    };

    service_lines = (struct service_lines){open_lines, refuse_line, end_lines, NULL};
    bench_set_up();
    takt_panel_init(&panel, &config);
    takt_panel_client_enter(&sender, &panel);
    takt_panel_client_enter(&other, &panel);
    takt_lines_init(&lines, console_text, sizeof console_text);
    takt_console_init(&console, &console_config);
    forget();
    takt_console_enter(&console);
    begin_judging();
}

/* One cycle, and the console after it. */
static void step(void)
{
    verified_cycle();
    takt_console_step(&console);
}

static inline void steps(unsigned count)
{
    for (unsigned i = 0; i < count; i++)
        step();
}

/* Bytes as a sender that keeps count of the room gives them. */
static void give(const char *text)
{
    for (; *text != '\0'; text++) {
        for (unsigned i = 0; i < BENCH_CYCLES_MAX && !takt_console_has_room(&console); i++)
            step();
        takt_console_take(&console, (uint8_t)*text);
    }
    takt_console_step(&console);
}

static unsigned count_of(const char *word)
{
    unsigned count = 0;

    for (const char *at = said; (at = strstr(at, word)) != NULL; at++)
        count++;
    return count;
}

static unsigned answers(void)
{
    return count_of("ok\r\n") + count_of("error:");
}

/* Until there are this many answers. */
static void await(unsigned count)
{
    for (unsigned i = 0; i < BENCH_CYCLES_MAX && answers() < count; i++)
        step();
    TEST_ASSERT_EQUAL_UINT_MESSAGE(count, answers(), said);
}

static inline void settle(void)
{
    for (unsigned i = 0; i < BENCH_CYCLES_MAX && (takt_service_get_state(&service) != PANEL_IDLE ||
                                                  takt_console_is_waiting(&console));
         i++)
        step();
    TEST_ASSERT_EQUAL_INT_MESSAGE(PANEL_IDLE, takt_service_get_state(&service), said);
}

static void expect(const char *word)
{
    TEST_ASSERT_TRUE_MESSAGE(strstr(said, word) != NULL, said);
}

/* The answer to one line. */
static inline void ask(const char *line, const char *answer)
{
    forget();
    give(line);
    give("\n");
    await(1);
    expect(answer);
}

static inline void expect_status(const char *word)
{
    forget();
    give("?");
    expect(word);
}

#endif
