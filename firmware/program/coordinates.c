#include "program/coordinates.h"

#include "base/maths.h"
#include "program/report.h"
#include "program/words.h"

#include <string.h>

#define DEGREES_PER_RAD (180.0 / MATHS_PI)
#define RAD_PER_DEGREE  (MATHS_PI / 180.0)

static bool is_rotary(enum axis axis)
{
    return axis >= AXIS_LINEAR_COUNT;
}

static char letter_of(enum axis axis)
{
    return (char)(AXIS_LETTERS[axis] - 'A' + 'a');
}

static double offset_of(const struct program *p, enum axis axis)
{
    const struct program_modes *m = &p->modes;

    return m->system_offset.at[axis] + m->axis_offset.at[axis] + m->tool_offset.at[axis];
}

double coordinates_to_parameter(double value, enum axis axis)
{
    return is_rotary(axis) ? value * DEGREES_PER_RAD : value;
}

double coordinates_from_parameter(double value, enum axis axis)
{
    return is_rotary(axis) ? value * RAD_PER_DEGREE : value;
}

double coordinates_work(const struct program *p, enum axis axis)
{
    const double work = p->modes.at.at[axis] - offset_of(p, axis);

    return is_rotary(axis) ? work * DEGREES_PER_RAD : work / p->modes.unit_mm;
}

bool coordinates_word(const struct program *p, enum axis axis, double *value)
{
    const char letter = letter_of(axis);

    if (!words_has(p, letter)) {
        return false;
    }
    *value = words_value(p, letter) * (is_rotary(axis) ? RAD_PER_DEGREE : p->modes.unit_mm);
    return true;
}

void coordinates_end(const struct program *p, struct point *end)
{
    double value;

    *end = p->modes.at;
    for (enum axis i = AXIS_X; i < AXIS_COUNT; i++) {
        if (!coordinates_word(p, i, &value)) {
            continue;
        }
        if (words_has_step(p, STEP_MACHINE)) {
            end->at[i] = value;
        } else if (p->modes.incremental) {
            end->at[i] += value;
        } else {
            end->at[i] = value + offset_of(p, i);
        }
    }
}

/* Six parameters, first for X, as a point. */
static void point_from_parameters(const struct program *p, unsigned first, struct point *point)
{
    for (enum axis i = AXIS_X; i < AXIS_COUNT; i++) {
        const double value = parameters_get(p->config.parameters, first + i);

        point->at[i] = coordinates_from_parameter(value, i);
    }
}

static void load_system(struct program *p, unsigned system)
{
    const unsigned further = (system - 1) * PARAMETER_SYSTEM_STRIDE;

    p->modes.system = (uint8_t)system;
    point_from_parameters(p, PARAMETER_SYSTEM_OFFSET + further, &p->modes.system_offset);
}

void coordinates_open(struct program *p)
{
    const double system = parameters_get(p->config.parameters, PARAMETER_SYSTEM);
    const bool known = system >= 1.0 && system <= COORDINATES_SYSTEMS;

    load_system(p, known ? (unsigned)system : 1U);
    if (parameters_get(p->config.parameters, PARAMETER_AXIS_APPLIED) != 0.0) {
        point_from_parameters(p, PARAMETER_AXIS_OFFSET, &p->modes.axis_offset);
    }
}

/* The system in use already is not loaded again, as in LinuxCNC. */
bool coordinates_select(struct program *p, const struct program_code *code)
{
    const unsigned system = (unsigned)code->argument;
    const unsigned further = (system - 1) * PARAMETER_SYSTEM_STRIDE;
    const double rotation = parameters_get(p->config.parameters, PARAMETER_SYSTEM_ROTATE + further);

    if (rotation != 0.0) {
        return report_error_code(p, TAKT_ERROR_ROTATION_UNSUPPORTED, code->step, rotation);
    }
    if (system != p->modes.system) {
        load_system(p, system);
    }
    return words_store(p, code->step, PARAMETER_SYSTEM, system);
}

bool coordinates_set_axis_offset(struct program *p, const struct program_code *code)
{
    struct program_modes *m = &p->modes;
    double value;

    if ((p->words.given & LETTERS_AXES) == 0) {
        return report_error_code(p, TAKT_ERROR_AXIS_WORD_MISSING, code->step, 0.0);
    }
    for (enum axis i = AXIS_X; i < AXIS_COUNT; i++) {
        if (coordinates_word(p, i, &value)) {
            m->axis_offset.at[i] =
                m->at.at[i] - m->system_offset.at[i] - m->tool_offset.at[i] - value;
        }
        if (!words_store(p, code->step, PARAMETER_AXIS_OFFSET + i,
                         coordinates_to_parameter(m->axis_offset.at[i], i))) {
            return false;
        }
    }
    return words_store(p, code->step, PARAMETER_AXIS_APPLIED, 1.0);
}

bool coordinates_cancel_axis_offset(struct program *p, const struct program_code *code)
{
    memset(&p->modes.axis_offset, 0, sizeof(p->modes.axis_offset));
    for (enum axis i = AXIS_X; code->argument == 1 && i < AXIS_COUNT; i++) {
        if (!words_store(p, code->step, PARAMETER_AXIS_OFFSET + i, 0.0)) {
            return false;
        }
    }
    return words_store(p, code->step, PARAMETER_AXIS_APPLIED, 0.0);
}

bool coordinates_restore_axis_offset(struct program *p, const struct program_code *code)
{
    point_from_parameters(p, PARAMETER_AXIS_OFFSET, &p->modes.axis_offset);
    return words_store(p, code->step, PARAMETER_AXIS_APPLIED, 1.0);
}

/* H, or else the tool in the spindle. An unknown tool other than "no tool" is worth a warning. */
bool coordinates_use_tool(struct program *p, const struct program_code *code)
{
    uint32_t number = p->modes.tool_current;
    struct program_span span = p->words.code_span[code->step];

    if (words_has(p, 'h')) {
        if (!words_whole(p, 'h', 0.0, PROGRAM_TOOL_MAX, &number)) {
            return false;
        }
        span = p->words.span[LETTER_INDEX('h')];
    }
    const struct tool *tool = tool_table_find(p->config.tools, number);

    if (tool != NULL) {
        p->modes.tool_offset = tool->offset;
        return true;
    }
    memset(&p->modes.tool_offset, 0, sizeof(p->modes.tool_offset));
    if (number != 0) {
        report_warning(p, TAKT_ERROR_TOOL_UNKNOWN, span, number);
    }
    return true;
}

bool coordinates_drop_tool(struct program *p, const struct program_code *code)
{
    (void)code;
    memset(&p->modes.tool_offset, 0, sizeof(p->modes.tool_offset));
    return true;
}

/* G0 or G1: they use the axis words and nothing else. */
static bool is_straight(const struct program *p)
{
    return words_has_step(p, STEP_MOTION) && p->words.code[STEP_MOTION]->words == LETTERS_AXES;
}

bool coordinates_use_machine(struct program *p, const struct program_code *code)
{
    if (p->modes.incremental || !is_straight(p)) {
        return report_error_code(p, TAKT_ERROR_MACHINE_COORDINATES, code->step, 0.0);
    }
    return true;
}
