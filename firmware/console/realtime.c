/*
 * Bytes that act at once, wherever they stand in the text.
 */
#include "base/assert.h"
#include "console/console_private.h"

/* Control characters and those above ASCII. */
enum realtime {
    REALTIME_STATUS_HAL =
        0x80, /* these as grblHAL has them, for lines on which '?' '~' '!' are text */
    REALTIME_START_HAL = 0x81,
    REALTIME_HOLD_HAL = 0x82,
    REALTIME_MODES = 0x83,
    REALTIME_DOOR = 0x84,
    REALTIME_JOG_CANCEL = 0x85,
    REALTIME_STATUS_ALL = 0x87,
    REALTIME_OPTIONAL_STOP = 0x88,
    REALTIME_SINGLE_BLOCK = 0x89,
    REALTIME_FEED = 0x90,
    REALTIME_RAPID = 0x95,
    REALTIME_SPINDLE = 0x99,
    REALTIME_SPINDLE_STOP = 0x9e,
    REALTIME_FLOOD = 0xa0,
    REALTIME_MIST = 0xa1,
    REALTIME_RESET = 0x18,
    REALTIME_ABOVE_ASCII = 0x80
};

/* Overrides in counts of their registers: 0.1 %. */
#define WHOLE          1000
#define OVERRIDE_LEAST 100

/*
 * What is known of the spindle is older than what it is told by less than this, and a snapshot by
 * one more.
 */
#define FEEDBACK_CYCLES 5

/* What the bytes of a group of five do: set 100 %, or add this many counts. */
static const int steps[] = {0, 100, -100, 10, -10};

static void look(const struct console *c, struct panel_snapshot *now)
{
    c->config.port.look(c->config.port.context, now);
}

static void change_override(struct console *c, enum panel_id id, unsigned step)
{
    const struct panel_register *row = &takt_panel_registers[id];
    struct panel_snapshot now;
    int64_t value = WHOLE;
    int64_t least = takt_panel_least(row);

    TAKT_ASSERT(id < REGISTER_COUNT);
    look(c, &now);
    if (step > 0)
        value = (int64_t)now.value[id] + steps[step];
    if (least < OVERRIDE_LEAST)
        least = OVERRIDE_LEAST;
    if (value < least)
        value = least;
    if (value > (int64_t)panel_most(row))
        value = (int64_t)panel_most(row);
    (void)takt_console_order(c, id, value);
}

static void set_rapid(struct console *c, unsigned step)
{
    static const int64_t values[] = {1000, 500, 250};

    TAKT_ASSERT(step < sizeof values / sizeof values[0]);
    (void)takt_console_order(c, REGISTER_RAPID_OVERRIDE, values[step]);
}

static void toggle(struct console *c, enum panel_id id)
{
    struct panel_snapshot now;

    look(c, &now);
    (void)takt_console_order(c, id, now.value[id] == 0);
}

static void hold(struct console *c)
{
    c->resumes = false;
    (void)takt_console_order(c, REGISTER_FEED_HOLD, 1);
}

/* What a held spindle has to do first is done by takt_console_step. */
static void resume(struct console *c)
{
    struct panel_snapshot now;

    look(c, &now);
    if (console_state(&now) != PANEL_HELD)
        return;
    if (now.value[REGISTER_ALARM] != PANEL_ALARM_NONE)
        (void)takt_console_order(c, REGISTER_ACKNOWLEDGE, 1);
    if (now.value[REGISTER_SPINDLE_STOP] == 0)
        (void)takt_console_order(c, REGISTER_RESUME, 1);
    else
        c->resumes = takt_console_order(c, REGISTER_SPINDLE_STOP, 0) == PANEL_REFUSAL_NONE;
    c->turned = now.value[REGISTER_CYCLES] + FEEDBACK_CYCLES;
}

/* Held, with the spindle off. */
static void open_door(struct console *c)
{
    hold(c);
    c->is_door = true;
    (void)takt_console_order(c, REGISTER_SPINDLE_STOP, 1);
}

static void cancel_jog(struct console *c)
{
    struct panel_snapshot now;

    look(c, &now);
    if (console_state(&now) == PANEL_JOGGING)
        hold(c);
}

/* After an alarm nothing is enabled by it. Whoever may not give up what runs still holds it. */
static void reset(struct console *c)
{
    const struct panel_order order = {.count = 4,
                                      .item = {{REGISTER_RESET, 1},
                                               {REGISTER_FEED_OVERRIDE, WHOLE},
                                               {REGISTER_RAPID_OVERRIDE, WHOLE},
                                               {REGISTER_SPINDLE_OVERRIDE, WHOLE}}};
    enum panel_refusal refusal = PANEL_REFUSAL_NONE;
    struct panel_snapshot now;

    look(c, &now);
    if (console_state(&now) != PANEL_ALARM && console_state(&now) != PANEL_EMERGENCY)
        refusal = c->config.port.order(c->config.port.context, &order);
    c->resets = true;
    c->has_return = false;
    if (refusal == PANEL_REFUSAL_NONE || !takt_lines_are_read(c->config.lines))
        return;
    c->resets = false;
    hold(c);
    takt_console_message(c, "not reset: another panel has control");
}

static void report_modes(struct console *c)
{
    struct panel_snapshot now;

    look(c, &now);
    takt_console_report_modes(c, &now);
}

/* Bytes of overrides, in groups. False: it is none. */
static bool take_override(struct console *c, uint8_t byte)
{
    if (byte >= REALTIME_FEED && byte < REALTIME_RAPID)
        change_override(c, REGISTER_FEED_OVERRIDE, byte - REALTIME_FEED);
    else if (byte >= REALTIME_RAPID && byte < REALTIME_RAPID + 3)
        set_rapid(c, byte - REALTIME_RAPID);
    else if (byte >= REALTIME_SPINDLE && byte < REALTIME_SPINDLE_STOP)
        change_override(c, REGISTER_SPINDLE_OVERRIDE, byte - REALTIME_SPINDLE);
    else if (byte == REALTIME_SPINDLE_STOP)
        toggle(c, REGISTER_SPINDLE_STOP);
    else if (byte == REALTIME_FLOOD)
        toggle(c, REGISTER_FLOOD);
    else if (byte == REALTIME_MIST)
        toggle(c, REGISTER_MIST);
    else
        return false;
    return true;
}

/* Bytes that Grbl has. False: it is none. */
static bool take_known(struct console *c, uint8_t byte)
{
    if (byte == '?' || byte == REALTIME_STATUS_HAL || byte == REALTIME_STATUS_ALL)
        takt_console_report_status(c);
    else if (byte == '!' || byte == REALTIME_HOLD_HAL)
        hold(c);
    else if (byte == '~' || byte == REALTIME_START_HAL)
        resume(c);
    else if (byte == REALTIME_RESET)
        reset(c);
    else if (byte == REALTIME_DOOR)
        open_door(c);
    else if (byte == REALTIME_JOG_CANCEL)
        cancel_jog(c);
    else
        return false;
    return true;
}

/* Above ASCII there is no text: what is not known is dropped. */
bool takt_console_take_realtime(struct console *c, uint8_t byte)
{
    if (take_known(c, byte) || take_override(c, byte))
        return true;
    if (byte == REALTIME_MODES)
        report_modes(c);
    else if (byte == REALTIME_OPTIONAL_STOP)
        toggle(c, REGISTER_OPTIONAL_STOP);
    else if (byte == REALTIME_SINGLE_BLOCK)
        toggle(c, REGISTER_SINGLE_BLOCK);
    return byte >= REALTIME_ABOVE_ASCII;
}
