/*
 * $J=: a straight line to a place, by words of its own. The modes of the text around it count only
 * where Grbl says so: units (G20, G21) and distances (G90, G91).
 */
#include "base/assert.h"
#include "base/decimal.h"
#include "base/maths.h"
#include "console/characters.h"
#include "console/console_private.h"

#include <string.h>

#define MM_PER_INCH     25.4
#define MM_PER_COUNT    0.001
#define DEGREES_PER_RAD (180.0 / MATHS_PI)

/* Bits of register MODES. */
#define MODES_INCREMENTAL (1U << 2)
#define MODES_INCHES      (1U << 3)

/* Decimals of the place it ends at. */
#define PLACES 4

/* G words, by their number times ten. */
enum { G20 = 200, G21 = 210, G53 = 530, G90 = 900, G91 = 910 };

struct jog {
    double word[AXIS_COUNT]; /* as written */
    unsigned axes;           /* bit i: word i is there */
    double feed;             /* 0: none */
    bool inches, incremental, machine;
};

static bool take_g(struct jog *j, double number)
{
    switch ((int)(10.0 * number)) {
    case G20:
        j->inches = true;
        return true;
    case G21:
        j->inches = false;
        return true;
    case G90:
        j->incremental = false;
        return true;
    case G91:
        j->incremental = true;
        return true;
    case G53:
        j->machine = true;
        return true;
    default:
        return false;
    }
}

static enum console_error take_axis(struct jog *j, const struct machine *machine, unsigned axis,
                                    double value)
{
    TAKT_ASSERT(axis < AXIS_COUNT);
    if (!machine->axis[axis].present)
        return CONSOLE_UNSUPPORTED;
    if ((j->axes & 1U << axis) != 0)
        return CONSOLE_WORD_REPEATED;
    j->axes |= 1U << axis;
    j->word[axis] = value;
    return CONSOLE_OK;
}

static enum console_error take_word(struct jog *j, const struct machine *machine, char letter,
                                    double value)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (letter == AXIS_LETTERS[i])
            return take_axis(j, machine, i, value);
    }
    if (letter == 'F' && value <= 0.0)
        return CONSOLE_NEGATIVE;
    if (letter == 'F')
        j->feed = value;
    else if (letter == 'G')
        return value < 1000.0 && take_g(j, value) ? CONSOLE_OK : CONSOLE_BAD_JOG;
    else if (letter != 'N')
        return CONSOLE_BAD_JOG;
    return CONSOLE_OK;
}

/* A signed number; behind it *text goes on. False: there is none. */
static bool read_number(const char **text, double *value)
{
    const bool negative = **text == '-';
    size_t length;

    *text += **text == '-' || **text == '+';
    length = takt_decimal_read(*text, characters_length(*text), value);
    *text += length;
    *value = negative ? -*value : *value;
    return length > 0;
}

static enum console_error read_words(struct jog *j, const struct machine *machine, const char *text)
{
    enum console_error error = CONSOLE_OK;

    for (text = characters_skip_spaces(text); *text != '\0' && error == CONSOLE_OK;
         text = characters_skip_spaces(text)) {
        const char letter = characters_upper(*text++);
        double value;

        if (letter < 'A' || letter > 'Z')
            return CONSOLE_NO_LETTER;
        text = characters_skip_spaces(text);
        if (!read_number(&text, &value))
            return CONSOLE_BAD_NUMBER;
        error = take_word(j, machine, letter, value);
    }
    if (error != CONSOLE_OK)
        return error;
    if (j->axes == 0)
        return CONSOLE_NO_AXIS_WORD;
    return j->feed > 0.0 ? CONSOLE_OK : CONSOLE_NO_FEED;
}

static double shown(const struct panel_snapshot *now, enum panel_id first, unsigned axis)
{
    TAKT_ASSERT(axis < AXIS_COUNT);
    return MM_PER_COUNT * (double)panel_value(now, (enum panel_id)(first + axis));
}

/* Machine coordinates, mm and degrees, of where an axis is to go. */
static double target(const struct jog *j, const struct panel_snapshot *now, unsigned axis)
{
    const double at = shown(now, REGISTER_POSITION_X, axis);
    const double word = j->word[axis] * (j->inches && axis < AXIS_LINEAR_COUNT ? MM_PER_INCH : 1.0);

    TAKT_ASSERT(axis < AXIS_COUNT);
    if (j->incremental)
        return at + word;
    return j->machine ? word : word + at - shown(now, REGISTER_WORK_POSITION_X, axis);
}

static bool is_within(const struct machine_axis *axis, double place)
{
    const double unit = axis->rotary ? DEGREES_PER_RAD : 1.0;

    return place >= axis->travel_min_mm * unit && place <= axis->travel_max_mm * unit;
}

static char *write_word(char *text, char letter, double value)
{
    *text++ = letter;
    return text + takt_decimal_write(text, value, PLACES);
}

/* "G21 G90 G94 G53 G1 X1.0000F600.0000". False: an axis would leave its travel. */
static bool write_line(const struct jog *j, const struct machine *machine,
                       const struct panel_snapshot *now, char *text)
{
    static const char modes[] = "G21 G90 G94 G53 G1 ";

    memcpy(text, modes, sizeof modes - 1);
    text += sizeof modes - 1;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const double place = target(j, now, i);

        if ((j->axes & 1U << i) == 0)
            continue;
        if (!is_within(&machine->axis[i], place))
            return false;
        text = write_word(text, AXIS_LETTERS[i], place);
    }
    text = write_word(text, 'F', j->feed * (j->inches ? MM_PER_INCH : 1.0));
    *text = '\0';
    return true;
}

static enum console_result refuse(struct console *c, enum console_error error)
{
    takt_console_answer(c, error);
    return CONSOLE_ANSWERED;
}

/*
 * Another jog is under way: this one follows it. What still runs of the text before has set its
 * modes alone.
 */
static bool follows(struct console *c, const struct panel_snapshot *now)
{
    const enum panel_state state = console_state(now);

    if (takt_lines_are_read(c->config.lines) && now->value[REGISTER_FEED] == 0) {
        takt_lines_finish(c->config.lines);
        return true;
    }
    return state == PANEL_JOGGING || state == PANEL_STOPPING || state == PANEL_STARTING;
}

enum console_result takt_console_jog(struct console *c, const char *text,
                                     const struct panel_snapshot *now)
{
    const uint32_t modes = now->value[REGISTER_MODES];
    struct jog jog = {.inches = (modes & MODES_INCHES) != 0,
                      .incremental = (modes & MODES_INCREMENTAL) != 0};
    struct panel_order order = {
        .count = 2,
        .item = {{REGISTER_MODE, PANEL_MODE_MDI}, {REGISTER_MDI_START, 1}},
        .text = PANEL_ORDER_JOG,
    };
    const enum console_error error = read_words(&jog, c->config.machine, text);
    enum panel_refusal refusal;

    if (error != CONSOLE_OK)
        return refuse(c, error);
    if (c->is_locked || c->is_asleep)
        return refuse(c, CONSOLE_LOCKED);
    if (follows(c, now))
        return CONSOLE_WAITS;
    if (console_state(now) != PANEL_IDLE || c->is_checking)
        return refuse(c, CONSOLE_NOT_IDLE);
    if (!write_line(&jog, c->config.machine, now, order.mdi))
        return refuse(c, CONSOLE_BEYOND_TRAVEL);
    refusal = c->config.port.order(c->config.port.context, &order);
    c->jogs = refusal == PANEL_REFUSAL_NONE;
    return c->jogs ? refuse(c, CONSOLE_OK) : takt_console_refuse(c, refusal);
}
