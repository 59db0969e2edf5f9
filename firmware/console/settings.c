/*
 * Settings: what of the machine a sender asks for under Grbl's numbers. They are the machine file's
 * and are read; two are of the reports and may be set, until the next sender comes.
 */
#include "base/assert.h"
#include "base/decimal.h"
#include "base/maths.h"
#include "console/characters.h"
#include "console/console_private.h"

#define S_PER_MIN       60.0
#define DEGREES_PER_RAD (180.0 / MATHS_PI)

/* Numbers of settings; of a group, which has one for each axis, the first. */
enum {
    SETTING_MASK = 10,
    SETTING_INCHES = 13,
    SETTING_STEPS = 100,
    SETTING_RATE = 110,
    SETTING_ACCELERATION = 120,
    SETTING_TRAVEL = 130
};

/* Millionths of it may be lost on the way through a sender. */
#define SAME 1e-3

struct setting {
    uint16_t number;
    uint8_t decimals;
    double (*get)(const struct console *c, unsigned axis);
};

static double zero(const struct console *c, unsigned axis)
{
    (void)c;
    (void)axis;
    return 0.0;
}

static double one(const struct console *c, unsigned axis)
{
    (void)c;
    (void)axis;
    return 1.0;
}

static double get_mask(const struct console *c, unsigned axis)
{
    (void)axis;
    return (double)c->mask;
}

static double get_inches(const struct console *c, unsigned axis)
{
    (void)axis;
    return c->in_inches ? 1.0 : 0.0;
}

static double get_tolerance(const struct console *c, unsigned axis)
{
    (void)axis;
    return 1.0 / c->config.machine->resolution_per_mm;
}

static double get_path_tolerance(const struct console *c, unsigned axis)
{
    (void)axis;
    return c->config.machine->path_tolerance_mm;
}

static double get_speed(const struct console *c, unsigned axis)
{
    (void)axis;
    return c->config.machine->spindle_max_rpm;
}

/* The first axis that finds its home stands for all. NULL: none does. */
static const struct machine_axis *homed_axis(const struct console *c)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct machine_axis *axis = &c->config.machine->axis[i];

        if (axis->present && axis->home_order != 0)
            return axis;
    }
    return NULL;
}

static double get_home_rate(const struct console *c, unsigned axis)
{
    const struct machine_axis *home = homed_axis(c);

    (void)axis;
    return home != NULL ? home->home_zero_velocity_mm_s * S_PER_MIN : 0.0;
}

static double get_seek_rate(const struct console *c, unsigned axis)
{
    const struct machine_axis *home = homed_axis(c);

    (void)axis;
    return home != NULL ? home->home_velocity_mm_s * S_PER_MIN : 0.0;
}

static double unit_of(const struct machine_axis *axis)
{
    return axis->rotary ? DEGREES_PER_RAD : 1.0;
}

static double get_steps(const struct console *c, unsigned axis)
{
    const struct machine_axis *a = &c->config.machine->axis[axis];

    TAKT_ASSERT(axis < AXIS_COUNT);
    return (a->drive_type == MACHINE_DRIVE_STEP ? a->steps_per_mm
                                                : maths_abs(a->increments_per_mm)) /
           unit_of(a);
}

static double get_rate(const struct console *c, unsigned axis)
{
    const struct machine_axis *a = &c->config.machine->axis[axis];

    TAKT_ASSERT(axis < AXIS_COUNT);
    return a->max_velocity_mm_s * unit_of(a) * S_PER_MIN;
}

static double get_acceleration(const struct console *c, unsigned axis)
{
    const struct machine_axis *a = &c->config.machine->axis[axis];

    TAKT_ASSERT(axis < AXIS_COUNT);
    return a->max_acceleration_mm_s2 * unit_of(a);
}

static double get_travel(const struct console *c, unsigned axis)
{
    const struct machine_axis *a = &c->config.machine->axis[axis];

    TAKT_ASSERT(axis < AXIS_COUNT);
    return (a->travel_max_mm - a->travel_min_mm) * unit_of(a);
}

/*
 * Homing ($22) always does something: without switches the axes go to machine zero. Travel ($20) is
 * always watched.
 */
static const struct setting settings[] = {
    {0, 0, zero},
    {1, 0, zero},
    {2, 0, zero},
    {3, 0, zero},
    {4, 0, zero},
    {5, 0, zero},
    {6, 0, zero},
    {SETTING_MASK, 0, get_mask},
    {11, 3, get_path_tolerance},
    {12, 3, get_tolerance},
    {SETTING_INCHES, 0, get_inches},
    {20, 0, one},
    {21, 0, zero},
    {22, 0, one},
    {23, 0, zero},
    {24, 3, get_home_rate},
    {25, 3, get_seek_rate},
    {26, 0, zero},
    {27, 3, zero},
    {30, 0, get_speed},
    {31, 0, zero},
    {32, 0, zero},
    {SETTING_STEPS, 3, get_steps},
    {SETTING_RATE, 3, get_rate},
    {SETTING_ACCELERATION, 3, get_acceleration},
    {SETTING_TRAVEL, 3, get_travel},
};

#define SETTINGS (sizeof settings / sizeof settings[0])

static bool is_of_axes(const struct setting *s)
{
    return s->number >= SETTING_STEPS;
}

static void report(struct console *c, const struct setting *s, unsigned axis)
{
    takt_reply_text(&c->reply, "$");
    takt_reply_counts(&c->reply, (int64_t)s->number + axis, 0);
    takt_reply_text(&c->reply, "=");
    takt_reply_number(&c->reply, s->get(c, axis), s->decimals);
    takt_console_line_end(c);
}

void takt_console_report_settings(struct console *c)
{
    for (size_t i = 0; i < SETTINGS; i++) {
        for (unsigned axis = 0; axis < (is_of_axes(&settings[i]) ? AXIS_COUNT : 1U); axis++) {
            if (!is_of_axes(&settings[i]) || c->config.machine->axis[axis].present)
                report(c, &settings[i], axis);
        }
    }
}

/* NULL: there is none of this number. */
static const struct setting *find(const struct console *c, unsigned number, unsigned *axis)
{
    for (size_t i = 0; i < SETTINGS; i++) {
        const struct setting *s = &settings[i];

        *axis = number - s->number;
        if (number >= s->number && *axis < (is_of_axes(s) ? AXIS_COUNT : 1U) &&
            (!is_of_axes(s) || c->config.machine->axis[*axis].present))
            return s;
    }
    return NULL;
}

/* What is there already may be written. */
static enum console_error set(struct console *c, unsigned number, double value)
{
    unsigned axis;
    const struct setting *s = find(c, number, &axis);

    if (s == NULL)
        return CONSOLE_UNKNOWN_COMMAND;
    if (number == SETTING_MASK && value <= 3.0) {
        c->mask = (uint8_t)value;
        return CONSOLE_OK;
    }
    if (number == SETTING_INCHES && value <= 1.0) {
        c->in_inches = value != 0.0;
        return CONSOLE_OK;
    }
    return maths_abs(s->get(c, axis) - value) <= SAME ? CONSOLE_OK : CONSOLE_UNKNOWN_COMMAND;
}

enum console_error takt_console_set(struct console *c, const char *text)
{
    double number, value;
    size_t length = takt_decimal_read(text, characters_length(text), &number);
    enum console_error error;

    if (length == 0 || text[length] != '=' || number > UINT16_MAX ||
        number != takt_maths_floor(number))
        return CONSOLE_UNKNOWN_COMMAND;
    text += length + 1;
    if (*text == '-')
        return CONSOLE_NEGATIVE;
    length = takt_decimal_read(text, characters_length(text), &value);
    if (length == 0 || !characters_are_blank(text + length))
        return CONSOLE_BAD_NUMBER;
    error = set(c, (unsigned)number, value);
    if (error != CONSOLE_OK)
        takt_console_message(c, "settings are those of the machine file");
    return error;
}
