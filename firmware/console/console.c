#include "console/console.h"

#include "console/characters.h"
#include "console/console_private.h"

#include <string.h>

/* A snapshot may be a cycle older than the end of a program. */
#define SETTLING_CYCLES 2

void takt_console_init(struct console *c, const struct console_config *config)
{
    memset(c, 0, sizeof *c);
    c->config = *config;
    c->reply.write = config->port.write;
    c->reply.context = config->port.context;
    c->mask = CONSOLE_MASK_MACHINE | CONSOLE_MASK_BUFFER;
}

bool takt_console_has_room(const struct console *c)
{
    return takt_lines_room(c->config.lines) > 0;
}

bool takt_console_is_waiting(const struct console *c)
{
    char text[LINES_LENGTH_MAX + 1];

    return c->pending > 0 || c->resets || c->resumes || c->is_settling ||
           takt_lines_are_read(c->config.lines) || takt_lines_look(c->config.lines, text) != 0;
}

/* ---- replies ---- */

void takt_console_line_end(struct console *c)
{
    takt_reply_text(&c->reply, "\r\n");
    takt_reply_send(&c->reply);
}

void takt_console_answer(struct console *c, enum console_error error)
{
    if (error == CONSOLE_OK) {
        takt_reply_text(&c->reply, "ok");
    } else {
        takt_reply_text(&c->reply, "error:");
        takt_reply_counts(&c->reply, (int64_t)error, 0);
    }
    takt_console_line_end(c);
}

void takt_console_message(struct console *c, const char *text)
{
    takt_reply_text(&c->reply, "[MSG:");
    takt_reply_text(&c->reply, text);
    takt_reply_text(&c->reply, "]");
    takt_console_line_end(c);
}

void takt_console_welcome(struct console *c)
{
    takt_reply_text(&c->reply, "\r\nGrbl 1.1h ['$' for help]");
    takt_console_line_end(c);
    if (c->is_locked)
        takt_console_message(c, "'$H'|'$X' to unlock");
}

static void raise_alarm(struct console *c, enum console_alarm alarm, const char *text)
{
    takt_reply_text(&c->reply, "ALARM:");
    takt_reply_counts(&c->reply, (int64_t)alarm, 0);
    takt_console_line_end(c);
    if (text[0] != '\0')
        takt_console_message(c, text);
    c->is_locked = true;
}

/* ---- orders ---- */

enum panel_refusal takt_console_order(struct console *c, enum panel_id id, int64_t value)
{
    const struct panel_order order = {.count = 1, .item = {{id, value}}};

    return c->config.port.order(c->config.port.context, &order);
}

enum panel_refusal takt_console_order_two(struct console *c, enum panel_id id, int64_t value,
                                          enum panel_id second, int64_t second_value)
{
    const struct panel_order order = {.count = 2, .item = {{id, value}, {second, second_value}}};

    return c->config.port.order(c->config.port.context, &order);
}

enum console_result takt_console_refuse(struct console *c, enum panel_refusal refusal)
{
    if (refusal == PANEL_REFUSAL_BUSY)
        return CONSOLE_WAITS;
    if (refusal == PANEL_REFUSAL_CONTROL)
        takt_console_message(c, "another panel has control");
    else if (refusal == PANEL_REFUSAL_LOCKED)
        takt_console_message(c, "the password first: $PW=...");
    takt_console_answer(c, CONSOLE_LOCKED);
    return CONSOLE_ANSWERED;
}

/* ---- lines ---- */

/* The first character that says something; that of a command is '$'. */
static const char *command_of(const char *text)
{
    text = characters_skip_spaces(text);
    return *text == '$' ? text + 1 : NULL;
}

/* G38 of any kind; its result is told before its answer. */
static bool is_probing(const char *text)
{
    for (; *text != '\0'; text++) {
        if (characters_upper(text[0]) == 'G' && text[1] == '3' && text[2] == '8')
            return true;
    }
    return false;
}

static void tell_why(struct console *c)
{
    struct diagnostic why;
    char text[DIAGNOSTIC_TEXT_MAX];

    takt_lines_take_why(c->config.lines, &why);
    if (why.code == TAKT_OK)
        return;
    (void)takt_diagnostic_text(&why, text);
    takt_console_message(c, text);
}

/* A sender that has reset counts no more on answers to what it sent before. */
static void collect(struct console *c)
{
    char text[LINES_LENGTH_MAX + 1];
    uint8_t answer;

    while (takt_lines_collect(c->config.lines, text, &answer)) {
        c->pending--;
        if (c->resets)
            continue;
        if (answer != CONSOLE_OK)
            tell_why(c);
        else if (is_probing(text))
            takt_console_report_probe(c);
        takt_console_answer(c, (enum console_error)answer);
    }
}

/* Text for a program is not taken now, and will not be by waiting. */
static bool is_locked_out(const struct console *c, enum panel_state state)
{
    switch (state) {
    case PANEL_RUNNING:
    case PANEL_MDI:
    case PANEL_JOGGING:
    case PANEL_HOMING:
    case PANEL_HELD:
    case PANEL_ALARM:
    case PANEL_EMERGENCY:
        return true;
    case PANEL_STARTING:
    case PANEL_IDLE:
    case PANEL_STOPPING:
    case PANEL_STATES:
        break;
    }
    return c->is_locked || c->is_asleep;
}

static enum panel_refusal start_program(struct console *c)
{
    const struct panel_order start = {
        .count = 2,
        .item = {{REGISTER_MODE, PANEL_MODE_MDI}, {REGISTER_MDI_START, 1}},
        .text = PANEL_ORDER_LINES,
    };

    const enum panel_refusal refusal = c->config.port.order(c->config.port.context, &start);

    c->was_active = refusal == PANEL_REFUSAL_NONE;
    return refusal;
}

static enum console_result answer_here(struct console *c, enum console_error error)
{
    if (c->pending > 0)
        return CONSOLE_WAITS;
    takt_console_answer(c, error);
    return CONSOLE_ANSWERED;
}

static enum console_result check_line(struct console *c, const char *text)
{
    enum takt_error error;

    if (c->pending > 0)
        return CONSOLE_WAITS;
    error = c->config.port.check(c->config.port.context, text, !c->has_checked);
    c->has_checked = true;
    return answer_here(c, error == TAKT_OK ? CONSOLE_OK : takt_console_error_of(error));
}

/* Without a program that reads it one is started. PANEL_REFUSAL_NONE: the line may be released. */
static enum panel_refusal prepare_program(struct console *c, enum panel_state state)
{
    if (takt_lines_are_read(c->config.lines))
        return takt_lines_are_finished(c->config.lines) ? PANEL_REFUSAL_BUSY : PANEL_REFUSAL_NONE;
    return state == PANEL_IDLE ? start_program(c) : PANEL_REFUSAL_BUSY;
}

/* CONSOLE_WAITS: also when it has been released, to *released. */
static enum console_result program_line(struct console *c, const char *text, enum panel_state state,
                                        bool *released)
{
    const bool active = takt_lines_are_read(c->config.lines);
    enum panel_refusal refusal;

    if (!active && characters_are_blank(text))
        return answer_here(c, CONSOLE_OK);
    if (c->is_checking)
        return check_line(c, text);
    if (c->is_locked || c->is_asleep || (!active && is_locked_out(c, state)))
        return answer_here(c, CONSOLE_LOCKED);
    refusal = prepare_program(c, state);
    if (refusal == PANEL_REFUSAL_STATE)
        refusal = PANEL_REFUSAL_BUSY;
    if (refusal != PANEL_REFUSAL_NONE)
        return c->pending > 0 ? CONSOLE_WAITS : takt_console_refuse(c, refusal);
    *released = true;
    return CONSOLE_WAITS;
}

/*
 * Answers come in the order of the lines. What needs the machine at rest is not kept waiting for
 * text that cannot come.
 */
static enum console_result own_line(struct console *c, uint8_t mark, const char *text,
                                    const struct panel_snapshot *now)
{
    if (c->pending > 0)
        return CONSOLE_WAITS;
    if (mark == LINES_LONG) {
        takt_console_answer(c, CONSOLE_LINE_TOO_LONG);
        return CONSOLE_ANSWERED;
    }
    return takt_console_command(c, command_of(text), now);
}

/* One line further. False: it waits, or there is none. */
static bool take_line(struct console *c, const struct panel_snapshot *now)
{
    struct lines *l = c->config.lines;
    char text[LINES_LENGTH_MAX + 1];
    const uint8_t mark = takt_lines_look(l, text);
    bool released = false;
    enum console_result result;

    if (mark == 0)
        return false;
    if (mark == LINES_OWN)
        result = CONSOLE_ANSWERED;
    else if (mark == LINES_LONG || command_of(text) != NULL)
        result = own_line(c, mark, text, now);
    else
        result = program_line(c, text, console_state(now), &released);
    if (released) {
        c->pending++;
        takt_lines_release(l);
    } else if (result == CONSOLE_ANSWERED) {
        takt_lines_skip(l);
    }
    return released || result == CONSOLE_ANSWERED;
}

/* ---- what happens by itself ---- */

/*
 * The program of the lines has ended; those it has not read are the console's again. Given up or
 * failed, nothing that was to follow goes on by itself.
 */
static void follow_program(struct console *c, const struct panel_snapshot *now)
{
    const bool active = takt_lines_are_read(c->config.lines);
    const enum takt_error cause = takt_lines_get_cause(c->config.lines);

    if (c->was_active && !active) {
        collect(c);
        takt_lines_take_back(c->config.lines);
        c->pending = 0;
        c->is_settling = true;
        c->settled = now->value[REGISTER_CYCLES] + SETTLING_CYCLES;
        if (cause != TAKT_OK && !c->resets)
            raise_alarm(c, takt_console_alarm_of(cause), now->alarm_text);
        c->was_alarm = c->was_alarm || cause != TAKT_OK;
    }
    c->was_active = active;
}

static enum console_alarm alarm_of(const struct console *c, const struct panel_snapshot *now)
{
    if (console_state(now) == PANEL_EMERGENCY)
        return CONSOLE_ALARM_EMERGENCY;
    if (c->homes)
        return CONSOLE_ALARM_HOMING;
    return now->value[REGISTER_ALARM] == PANEL_ALARM_DRIVE ? CONSOLE_ALARM_DRIVE
                                                           : CONSOLE_ALARM_ABORTED;
}

static void follow_alarm(struct console *c, const struct panel_snapshot *now)
{
    const bool is_alarm =
        console_state(now) == PANEL_ALARM || console_state(now) == PANEL_EMERGENCY;

    if (is_alarm && !c->was_alarm)
        raise_alarm(c, alarm_of(c, now), now->alarm_text);
    c->was_alarm = is_alarm;
}

/* All has come to rest. */
static void follow_reset(struct console *c, const struct panel_snapshot *now)
{
    if (!c->resets || takt_lines_are_read(c->config.lines) || console_state(now) == PANEL_STOPPING)
        return;
    c->resets = c->homes = c->resumes = c->is_asleep = c->is_checking = c->is_door = false;
    c->pending = 0;
    takt_lines_clear(c->config.lines);
    c->is_locked = console_state(now) == PANEL_ALARM || console_state(now) == PANEL_EMERGENCY;
    takt_console_welcome(c);
}

/* A spindle that was stopped in a hold turns before the axes do. */
static void follow_resume(struct console *c, const struct panel_snapshot *now)
{
    c->is_door = c->is_door && now->value[REGISTER_FEED_HOLD] != 0;
    if (!c->resumes || (int32_t)(now->value[REGISTER_CYCLES] - c->turned) < 0 ||
        (now->value[REGISTER_SPINDLE_STATUS] & 1U) == 0)
        return;
    c->resumes = false;
    if (console_state(now) == PANEL_HELD)
        (void)takt_console_order(c, REGISTER_RESUME, 1);
}

static void follow_jog(struct console *c, const struct panel_snapshot *now)
{
    c->jogs = c->jogs && console_state(now) == PANEL_JOGGING;
}

static bool has_settled(struct console *c, const struct panel_snapshot *now)
{
    if ((int32_t)(now->value[REGISTER_CYCLES] - c->settled) >= 0)
        c->is_settling = false;
    return !c->is_settling;
}

void takt_console_step(struct console *c)
{
    struct panel_snapshot now;

    collect(c);
    c->config.port.look(c->config.port.context, &now);
    follow_program(c, &now);
    if (!has_settled(c, &now))
        return;
    follow_alarm(c, &now);
    follow_reset(c, &now);
    follow_resume(c, &now);
    follow_jog(c, &now);
    while (!c->resets && take_line(c, &now))
        c->config.port.look(c->config.port.context, &now);
    collect(c);
}

/* ---- bytes ---- */

/* CR LF is one end of a line. */
static uint8_t line_byte(struct console *c, uint8_t byte)
{
    const bool follows = byte == '\n' && c->has_return;

    c->has_return = byte == '\r';
    if (follows)
        return 0;
    return byte == '\r' ? (uint8_t)'\n' : byte;
}

void takt_console_take(struct console *c, uint8_t byte)
{
    if (takt_console_take_realtime(c, byte))
        return;
    byte = line_byte(c, byte);
    if (byte != 0)
        (void)takt_lines_put(c->config.lines, byte);
}

void takt_console_enter(struct console *c)
{
    c->has_return = false;
    if (takt_lines_are_read(c->config.lines)) {
        (void)takt_console_take_realtime(c, 0x18);
        return;
    }
    c->pending = 0;
    takt_lines_clear(c->config.lines);
    takt_console_welcome(c);
}

void takt_console_leave(struct console *c)
{
    if (c->jogs)
        (void)takt_console_order(c, REGISTER_FEED_HOLD, 1);
    c->jogs = false;
}
