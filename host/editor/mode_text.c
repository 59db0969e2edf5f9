#include "editor/mode_text.h"

#include "program/predefined.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define SECONDS_PER_MINUTE 60.0
#define MM_PER_M           1000.0

__attribute__((format(printf, 2, 3))) static void add(char text[MODE_TEXT_MAX], const char *format,
                                                      ...)
{
    const size_t length = strlen(text);
    va_list arguments;

    va_start(arguments, format);
    (void)vsnprintf(text + length, MODE_TEXT_MAX - length, format, arguments);
    va_end(arguments);
}

static void add_code(char text[MODE_TEXT_MAX], const struct program_code *code, const char *none)
{
    if (code != NULL)
        add(text, "%c%g", code->letter - 'a' + 'A', code->number_x10 / 10.0);
    else
        add(text, "%s", none);
}

static void add_system(const struct program_modes *m, char text[MODE_TEXT_MAX])
{
    if (m->system <= 6)
        add(text, " G%u", 53U + m->system);
    else
        add(text, " G59.%u", m->system - 6U);
}

static void add_path(const struct program_modes *m, char text[MODE_TEXT_MAX])
{
    if (m->path != PATH_BLEND)
        add(text, "%s", m->path == PATH_EXACT ? " G61" : " G61.1");
    else if (m->tolerance_mm > 0.0)
        add(text, " G64 P%g", m->tolerance_mm / m->unit_mm);
    else
        add(text, " G64");
}

static bool has_length(const struct program_modes *m)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (m->tool_offset.at[i] != 0.0)
            return true;
    }
    return false;
}

static void add_machine(const struct program_modes *m, char text[MODE_TEXT_MAX])
{
    static const char *const spindle[] = {
        [SPINDLE_OFF] = " M5", [SPINDLE_CW] = " M3", [SPINDLE_CCW] = " M4"};

    add(text, "%s%s%s%s", spindle[m->direction], m->mist ? " M7" : "", m->flood ? " M8" : "",
        m->mist || m->flood ? "" : " M9");
}

static void add_codes(const struct program_modes *m, char text[MODE_TEXT_MAX])
{
    static const char *const plane[] = {
        [PLANE_XY] = " G17", [PLANE_ZX] = " G18", [PLANE_YZ] = " G19"};

    add_code(text, m->motion, "G80");
    add(text, "%s %s %s %s ", plane[m->plane], m->unit_mm == 1.0 ? "G21" : "G20",
        m->incremental ? "G91" : "G90", m->centre_absolute ? "G90.1" : "G91.1");
    add_code(text, m->cutter_code, "G40");
    add(text, "%s", has_length(m) ? " G43" : " G49");
    add_system(m, text);
    add_path(m, text);
    add(text, " %s", m->inverse_time ? "G93" : m->per_revolution ? "G95" : "G94");
    add(text, "%s %s%s", m->surface_speed ? " G96" : " G97", m->retract_to_r ? "G99" : "G98",
        m->diameter ? " G7" : "");
    add_machine(m, text);
}

static void add_values(const struct program_modes *m, char text[MODE_TEXT_MAX])
{
    const double feed = m->per_revolution ? m->feed_rev_mm : m->feed_mm_s * SECONDS_PER_MINUTE;

    if (feed > 0.0)
        add(text, "F%.6g ", feed / m->unit_mm);
    if (m->surface_speed)
        add(text, "S%.6g m/min ", m->surface_mm_s * SECONDS_PER_MINUTE / MM_PER_M);
    else
        add(text, "S%.6g ", m->speed_rpm);
    add(text, "T%u", (unsigned)m->tool_current);
    if (m->tool_is_selected && m->tool_selected != m->tool_current)
        add(text, " (selected: T%u)", (unsigned)m->tool_selected);
}

void mode_text_write(const struct program *p, unsigned axes, char text[MODE_TEXT_MAX])
{
    static const char names[AXIS_COUNT] = {'x', 'y', 'z', 'a', 'b', 'c'};

    text[0] = '\0';
    add_codes(&p->modes, text);
    add(text, "\n");
    add_values(&p->modes, text);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const char name[] = {'_', names[i], '\0'};
        double at;

        if ((axes & 1U << i) != 0 && takt_predefined_get(p, name, 2, &at))
            add(text, " %c%.4f", names[i] - 'a' + 'A', at + 0.0);
    }
}
