/*
 * Reports: where the machine is and what counts.
 */
#include "base/assert.h"
#include "console/console_private.h"

#define MM_PER_INCH 25.4

/* Decimals of positions in registers, whose unit is 0.001 mm. */
#define POSITION_DECIMALS 3

static void text(struct console *c, const char *words)
{
    takt_reply_text(&c->reply, words);
}

static void number(struct console *c, int64_t counts)
{
    takt_reply_counts(&c->reply, counts, 0);
}

/* ---- status ---- */

static bool moves(const struct panel_snapshot *now)
{
    uint32_t any = now->value[REGISTER_FEED];

    for (unsigned i = 0; i < AXIS_COUNT; i++)
        any |= now->value[REGISTER_AXIS_FEED_X + i];
    return any != 0;
}

static const char *idle_word(const struct console *c)
{
    if (c->is_locked)
        return "Alarm";
    if (c->is_asleep)
        return "Sleep";
    return c->is_checking ? "Check" : "Idle";
}

static const char *state_word(const struct console *c, const struct panel_snapshot *now)
{
    switch (console_state(now)) {
    case PANEL_STARTING:
    case PANEL_HOMING:
        return "Home";
    case PANEL_RUNNING:
    case PANEL_MDI:
        return "Run";
    case PANEL_JOGGING:
        return "Jog";
    case PANEL_HELD:
        if (c->is_door)
            return moves(now) ? "Door:2" : "Door:0";
        return moves(now) ? "Hold:1" : "Hold:0";
    case PANEL_STOPPING:
        return "Hold:1";
    case PANEL_ALARM:
    case PANEL_EMERGENCY:
        return "Alarm";
    case PANEL_IDLE:
    case PANEL_STATES:
        break;
    }
    return idle_word(c);
}

static void position(struct console *c, int64_t counts)
{
    if (c->in_inches)
        takt_reply_number(&c->reply, (double)counts * 0.001 / MM_PER_INCH, POSITION_DECIMALS + 1);
    else
        takt_reply_counts(&c->reply, counts, POSITION_DECIMALS);
}

/* Counts of each axis there is: of the row first, less those of the row second, if it is one. */
static void axes(struct console *c, const struct panel_snapshot *now, enum panel_id first,
                 enum panel_id second)
{
    const char *comma = "";

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        int64_t counts = panel_value(now, (enum panel_id)(first + i));

        if (!c->config.machine->axis[i].present)
            continue;
        if (second != REGISTER_COUNT)
            counts -= panel_value(now, (enum panel_id)(second + i));
        text(c, comma);
        position(c, counts);
        comma = ",";
    }
}

static void report_position(struct console *c, const struct panel_snapshot *now)
{
    const bool machine = (c->mask & CONSOLE_MASK_MACHINE) != 0;

    text(c, machine ? "|MPos:" : "|WPos:");
    axes(c, now, machine ? REGISTER_POSITION_X : REGISTER_WORK_POSITION_X, REGISTER_COUNT);
}

/* The planner takes lines as it needs them: room is told in lines of this many characters. */
#define BYTES_PER_LINE 8U

static void report_buffer(struct console *c)
{
    const uint32_t room = takt_lines_room(c->config.lines);

    if ((c->mask & CONSOLE_MASK_BUFFER) == 0)
        return;
    text(c, "|Bf:");
    number(c, room / BYTES_PER_LINE);
    text(c, ",");
    number(c, room);
}

static int64_t tenths(const struct panel_snapshot *now, enum panel_id id)
{
    const int64_t value = panel_value(now, id);

    return ((value < 0 ? -value : value) + 5) / 10;
}

static void report_rates(struct console *c, const struct panel_snapshot *now)
{
    text(c, "|FS:");
    number(c, tenths(now, REGISTER_FEED));
    text(c, ",");
    number(c, tenths(now, REGISTER_SPINDLE_COMMANDED));
}

/* Spindle and coolant. */
static void report_accessories(struct console *c, const struct panel_snapshot *now)
{
    const int64_t speed = panel_value(now, REGISTER_SPINDLE_COMMANDED);

    if (speed == 0 && now->value[REGISTER_COOLANT] == 0)
        return;
    text(c, "|A:");
    if (speed != 0)
        text(c, speed > 0 ? "S" : "C");
    if (now->value[REGISTER_FLOOD] != 0)
        text(c, "F");
    if (now->value[REGISTER_MIST] != 0)
        text(c, "M");
}

static void report_overrides(struct console *c, const struct panel_snapshot *now)
{
    text(c, "|Ov:");
    number(c, tenths(now, REGISTER_FEED_OVERRIDE));
    text(c, ",");
    number(c, tenths(now, REGISTER_RAPID_OVERRIDE));
    text(c, ",");
    number(c, tenths(now, REGISTER_SPINDLE_OVERRIDE));
}

static void report_pins(struct console *c, const struct panel_snapshot *now)
{
    const bool has_probe = now->value[REGISTER_PROBE] != 0;

    if (!has_probe && !c->is_door && now->value[REGISTER_EMERGENCY_STOP] == 0)
        return;
    text(c, "|Pn:");
    text(c, has_probe ? "P" : "");
    text(c, c->is_door ? "D" : "");
    text(c, now->value[REGISTER_EMERGENCY_STOP] != 0 ? "E" : "");
}

void takt_console_report_status(struct console *c)
{
    struct panel_snapshot now;

    c->config.port.look(c->config.port.context, &now);
    text(c, "<");
    text(c, state_word(c, &now));
    report_position(c, &now);
    report_buffer(c);
    report_rates(c, &now);
    report_pins(c, &now);
    text(c, "|WCO:");
    axes(c, &now, REGISTER_POSITION_X, REGISTER_WORK_POSITION_X);
    report_overrides(c, &now);
    report_accessories(c, &now);
    text(c, ">");
    takt_console_line_end(c);
}

/* ---- $G ---- */

static bool tell(struct console *c, enum console_fact fact, double value[AXIS_COUNT])
{
    return c->config.port.tell(c->config.port.context, fact, value);
}

/* A G word by its number times ten. */
static void g_word(struct console *c, uint32_t number_x10)
{
    TAKT_ASSERT(number_x10 < 10000);
    text(c, "G");
    number(c, number_x10 / 10);
    if (number_x10 % 10 != 0) {
        text(c, ".");
        number(c, number_x10 % 10);
    }
    text(c, " ");
}

/* G54 ... G59, G59.1 ... G59.3 as 1 ... 9. */
static uint32_t system_word(uint32_t system)
{
    return system <= 6 ? 530 + 10 * system : 590 + system - 6;
}

static void report_words(struct console *c, const struct panel_snapshot *now)
{
    double words[AXIS_COUNT] = {0.0};

    (void)tell(c, CONSOLE_FACT_WORDS, words);
    text(c, " M");
    takt_reply_number(&c->reply, words[3], 0);
    if (now->value[REGISTER_COOLANT] == 0)
        text(c, " M9");
    if (now->value[REGISTER_MIST] != 0)
        text(c, " M7");
    if (now->value[REGISTER_FLOOD] != 0)
        text(c, " M8");
    text(c, " T");
    takt_reply_number(&c->reply, words[4], 0);
    text(c, " F");
    takt_reply_number(&c->reply, words[1] / (c->in_inches ? MM_PER_INCH : 1.0), 0);
    text(c, " S");
    takt_reply_number(&c->reply, words[2], 0);
}

void takt_console_report_modes(struct console *c, const struct panel_snapshot *now)
{
    static const uint16_t paths[] = {610, 611, 640, 640};
    const uint32_t modes = now->value[REGISTER_MODES];

    text(c, "[GC:");
    g_word(c, modes >> 16);
    g_word(c, system_word(now->value[REGISTER_SYSTEM]));
    g_word(c, 170 + 10 * (modes & 3U));
    g_word(c, (modes & 1U << 3) != 0 ? 200 : 210);
    g_word(c, (modes & 1U << 2) != 0 ? 910 : 900);
    g_word(c, (modes & 1U << 8) != 0 ? 930 : (modes & 1U << 9) != 0 ? 950 : 940);
    text(c, "G");
    number(c, paths[modes >> 4 & 3U] / 10);
    text(c, paths[modes >> 4 & 3U] % 10 != 0 ? ".1" : "");
    report_words(c, now);
    text(c, "]");
    takt_console_line_end(c);
}

/* ---- $# ---- */

/* A position, or an angle: in inches the first is divided, and both have a decimal more. */
static void coordinate(struct console *c, double value, bool linear)
{
    takt_reply_number(&c->reply, value / (c->in_inches && linear ? MM_PER_INCH : 1.0),
                      c->in_inches ? POSITION_DECIMALS + 1 : POSITION_DECIMALS);
}

void takt_console_axes(struct console *c, const double value[AXIS_COUNT])
{
    const char *comma = "";

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (!c->config.machine->axis[i].present)
            continue;
        text(c, comma);
        coordinate(c, value[i], i < AXIS_LINEAR_COUNT);
        comma = ",";
    }
}

static void report_fact(struct console *c, const char *name, enum console_fact fact)
{
    double value[AXIS_COUNT] = {0.0};

    (void)tell(c, fact, value);
    text(c, "[");
    text(c, name);
    text(c, ":");
    takt_console_axes(c, value);
    text(c, "]");
    takt_console_line_end(c);
}

static void report_tool_offset(struct console *c)
{
    double value[AXIS_COUNT] = {0.0};

    (void)tell(c, CONSOLE_FACT_TOOL_OFFSET, value);
    text(c, "[TLO:");
    coordinate(c, value[AXIS_Z], true);
    text(c, "]");
    takt_console_line_end(c);
}

void takt_console_report_probe(struct console *c)
{
    double value[AXIS_COUNT] = {0.0}, words[AXIS_COUNT] = {0.0};

    (void)tell(c, CONSOLE_FACT_PROBE, value);
    (void)tell(c, CONSOLE_FACT_WORDS, words);
    text(c, "[PRB:");
    takt_console_axes(c, value);
    text(c, words[0] != 0.0 ? ":1]" : ":0]");
    takt_console_line_end(c);
}

void takt_console_report_offsets(struct console *c)
{
    static const struct {
        const char *name;
        enum console_fact fact;
    } rows[] = {
        {"G54", CONSOLE_FACT_SYSTEM},      {"G55", CONSOLE_FACT_SYSTEM + 1},
        {"G56", CONSOLE_FACT_SYSTEM + 2},  {"G57", CONSOLE_FACT_SYSTEM + 3},
        {"G58", CONSOLE_FACT_SYSTEM + 4},  {"G59", CONSOLE_FACT_SYSTEM + 5},
        {"G28", CONSOLE_FACT_REFERENCE_1}, {"G30", CONSOLE_FACT_REFERENCE_2},
        {"G92", CONSOLE_FACT_AXIS_OFFSET},
    };

    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        report_fact(c, rows[i].name, rows[i].fact);
    report_tool_offset(c);
    takt_console_report_probe(c);
}

/* ---- $I ---- */

static void report_axes(struct console *c)
{
    unsigned count = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++)
        count += c->config.machine->axis[i].present;
    text(c, "[AXS:");
    number(c, count);
    text(c, ":");
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const char letter[2] = {AXIS_LETTERS[i], '\0'};

        text(c, c->config.machine->axis[i].present ? letter : "");
    }
    text(c, "]");
    takt_console_line_end(c);
}

/*
 * Grbl's letters of what it has been built with: variable spindle, mist; $RST=*, $RST=$ and $I=text
 * are not there, and power-on is no alarm although there is homing.
 */
#define OPTIONS "VM*$IL"

void takt_console_report_build(struct console *c, bool extended)
{
    const uint32_t room = takt_lines_capacity(c->config.lines);

    text(c, "[VER:1.1h.takt-");
    text(c, c->config.version);
    text(c, ":");
    text(c, c->config.machine->name);
    text(c, "]\r\n[OPT:" OPTIONS ",");
    number(c, room / BYTES_PER_LINE);
    text(c, ",");
    number(c, room);
    text(c, "]");
    takt_console_line_end(c);
    if (!extended)
        return;
    report_axes(c);
    text(c, "[NEWOPT:RT+]\r\n[FIRMWARE:takt]");
    takt_console_line_end(c);
}
