/*
 * Lines that begin with '$'.
 */
#include "base/decimal.h"
#include "console/characters.h"
#include "console/console_private.h"

/* Upper and lower case are one; what stands behind the first word is the command's. */
static bool is_command(const char *text, const char *name)
{
    for (; *name != '\0'; name++, text++) {
        if (characters_upper(*text) != *name)
            return false;
    }
    return true;
}

static bool is_exactly(const char *text, const char *name)
{
    return is_command(text, name) && characters_are_blank(text + characters_length(name));
}

static enum console_result answer(struct console *c, enum console_error error)
{
    takt_console_answer(c, error);
    return CONSOLE_ANSWERED;
}

/*
 * Text that stands before the line comes to its end, since no more of it can come. While the axes
 * move that would be long: the line is then refused, as it is where others move them.
 */
static bool waits_for_rest(struct console *c, const struct panel_snapshot *now)
{
    const enum panel_state state = console_state(now);

    if (!takt_lines_are_read(c->config.lines))
        return state == PANEL_STOPPING || state == PANEL_STARTING;
    if (now->value[REGISTER_FEED] != 0)
        return false;
    takt_lines_finish(c->config.lines);
    return true;
}

static enum console_result unlock(struct console *c, const struct panel_snapshot *now)
{
    enum panel_refusal refusal = PANEL_REFUSAL_NONE;

    if (console_state(now) == PANEL_EMERGENCY) {
        takt_console_message(c, "emergency stop");
        return answer(c, CONSOLE_LOCKED);
    }
    if (console_state(now) == PANEL_ALARM)
        refusal = takt_console_order(c, REGISTER_RESET, 1);
    if (refusal != PANEL_REFUSAL_NONE)
        return takt_console_refuse(c, refusal);
    if (c->is_locked)
        takt_console_message(c, "Caution: Unlocked");
    c->is_locked = false;
    return answer(c, CONSOLE_OK);
}

/* The axes look for their homes, and the line waits until they are there. */
static enum console_result await_home(struct console *c, const struct panel_snapshot *now)
{
    const enum panel_state state = console_state(now);

    if (state == PANEL_HOMING || state == PANEL_STARTING || state == PANEL_STOPPING)
        return CONSOLE_WAITS;
    c->homes = false;
    return answer(c, state == PANEL_IDLE ? CONSOLE_OK : CONSOLE_LOCKED);
}

static enum console_result home(struct console *c, const struct panel_snapshot *now)
{
    enum panel_refusal refusal;

    if (c->homes)
        return await_home(c, now);
    if (waits_for_rest(c, now))
        return CONSOLE_WAITS;
    if (console_state(now) == PANEL_ALARM) {
        refusal = takt_console_order(c, REGISTER_RESET, 1);
        return refusal == PANEL_REFUSAL_NONE ? CONSOLE_WAITS : takt_console_refuse(c, refusal);
    }
    if (console_state(now) != PANEL_IDLE || c->is_asleep)
        return answer(c, CONSOLE_NOT_IDLE);
    refusal = takt_console_order_two(c, REGISTER_MODE, PANEL_MODE_JOG, REGISTER_HOME, 1);
    if (refusal != PANEL_REFUSAL_NONE)
        return takt_console_refuse(c, refusal);
    c->is_locked = false;
    c->homes = true;
    return CONSOLE_WAITS;
}

static enum console_result check(struct console *c, const struct panel_snapshot *now)
{
    if (c->config.port.check == NULL)
        return answer(c, CONSOLE_UNKNOWN_COMMAND);
    if (!c->is_checking && waits_for_rest(c, now))
        return CONSOLE_WAITS;
    if (!c->is_checking && (console_state(now) != PANEL_IDLE || c->is_locked))
        return answer(c, CONSOLE_NOT_IDLE);
    c->is_checking = !c->is_checking;
    c->has_checked = false;
    takt_console_message(c, c->is_checking ? "Enabled" : "Disabled");
    return answer(c, CONSOLE_OK);
}

/*
 * Spindle and coolant off, and no line is taken until a reset. The drives stay on: they hold what
 * hangs.
 */
static enum console_result sleep(struct console *c, const struct panel_snapshot *now)
{
    enum panel_refusal refusal;

    if (waits_for_rest(c, now))
        return CONSOLE_WAITS;
    if (console_state(now) != PANEL_IDLE)
        return answer(c, CONSOLE_NOT_IDLE);
    refusal = takt_console_order(c, REGISTER_RESET, 1);
    if (refusal != PANEL_REFUSAL_NONE)
        return takt_console_refuse(c, refusal);
    c->is_asleep = true;
    takt_console_message(c, "Sleeping");
    return answer(c, CONSOLE_OK);
}

/* "PW=12345" */
static enum console_result password(struct console *c, const char *digits)
{
    double value;
    const size_t length = takt_decimal_read(digits, characters_length(digits), &value);
    enum panel_refusal refusal;

    if (length == 0 || digits[length] != '\0' || value > UINT32_MAX)
        return answer(c, CONSOLE_BAD_NUMBER);
    refusal = c->config.port.unlock(c->config.port.context, (uint32_t)value);
    return answer(c, refusal == PANEL_REFUSAL_NONE ? CONSOLE_OK : CONSOLE_LOCKED);
}

static char *write_text(char *to, const char *text)
{
    for (; *text != '\0'; text++)
        *to++ = *text;
    return to;
}

/* Offsets of G54 to G59 and of G92 to 0, as lines of a program. */
static void write_zeros(const struct machine *machine, char *text)
{
    for (unsigned system = 1; system <= 6; system++) {
        text = write_text(text, "G10L2P");
        *text++ = "0123456"[system];
        for (unsigned i = 0; i < AXIS_COUNT; i++) {
            if (machine->axis[i].present) {
                *text++ = AXIS_LETTERS[i];
                *text++ = '0';
            }
        }
        *text++ = '\n';
    }
    *write_text(text, "G92.1") = '\0';
}

static enum console_result restore(struct console *c, const struct panel_snapshot *now)
{
    struct panel_order order = {
        .count = 2,
        .item = {{REGISTER_MODE, PANEL_MODE_MDI}, {REGISTER_MDI_START, 1}},
    };
    enum panel_refusal refusal;

    if (waits_for_rest(c, now))
        return CONSOLE_WAITS;
    if (console_state(now) != PANEL_IDLE || c->is_locked)
        return answer(c, CONSOLE_NOT_IDLE);
    write_zeros(c->config.machine, order.mdi);
    refusal = c->config.port.order(c->config.port.context, &order);
    return refusal == PANEL_REFUSAL_NONE ? answer(c, CONSOLE_OK) : takt_console_refuse(c, refusal);
}

/* Lines at start are none: those that are to be empty are. */
static enum console_error startup_line(const char *text)
{
    return text[0] == 'N' && (text[1] == '0' || text[1] == '1') && text[2] == '=' && text[3] == '\0'
               ? CONSOLE_OK
               : CONSOLE_UNKNOWN_COMMAND;
}

static void help(struct console *c)
{
    takt_reply_text(&c->reply,
                    "[HLP:$$ $# $G $I $N $x=val $Nx=line $J=line $SLP $C $X $H ~ ! ? ctrl-x]");
    takt_console_line_end(c);
}

static void report_startup(struct console *c)
{
    takt_reply_text(&c->reply, "$N0=\r\n$N1=");
    takt_console_line_end(c);
}

/* False: it is no report. */
static bool report(struct console *c, const char *text, const struct panel_snapshot *now)
{
    if (is_exactly(text, ""))
        help(c);
    else if (is_exactly(text, "$"))
        takt_console_report_settings(c);
    else if (is_exactly(text, "#"))
        takt_console_report_offsets(c);
    else if (is_exactly(text, "G"))
        takt_console_report_modes(c, now);
    else if (is_exactly(text, "I") || is_exactly(text, "I+"))
        takt_console_report_build(c, text[1] == '+');
    else if (is_exactly(text, "N"))
        report_startup(c);
    else
        return false;
    return true;
}

enum console_result takt_console_command(struct console *c, const char *text,
                                         const struct panel_snapshot *now)
{
    if (report(c, text, now))
        return answer(c, CONSOLE_OK);
    if (is_command(text, "J="))
        return takt_console_jog(c, text + 2, now);
    if (is_exactly(text, "X"))
        return unlock(c, now);
    if (is_exactly(text, "H"))
        return home(c, now);
    if (is_exactly(text, "C"))
        return check(c, now);
    if (is_exactly(text, "SLP"))
        return sleep(c, now);
    if (is_exactly(text, "RST=#"))
        return restore(c, now);
    if (is_command(text, "PW="))
        return password(c, text + 3);
    if (is_command(text, "N"))
        return answer(c, startup_line(text));
    return answer(c, takt_console_set(c, text));
}
