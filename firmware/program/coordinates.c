#include "program/coordinates.h"

#include "base/assert.h"
#include "base/maths.h"
#include "program/report.h"
#include "program/straight.h"
#include "program/tool_values.h"
#include "program/words.h"

#include <string.h>

#define DEGREES_PER_RAD (180.0 / MATHS_PI)
#define RAD_PER_DEGREE  (MATHS_PI / 180.0)

static bool is_rotary(enum axis axis)
{
    return axis >= AXIS_LINEAR_COUNT;
}

char takt_coordinates_letter(enum axis axis)
{
    TAKT_ASSERT(axis < AXIS_COUNT);
    return (char)(AXIS_LETTERS[axis] - 'A' + 'a');
}

static double offset_of(const struct program *p, enum axis axis)
{
    const struct program_modes *m = &p->modes;

    TAKT_ASSERT(axis < AXIS_COUNT);
    return m->system_offset.at[axis] + m->axis_offset.at[axis] + m->tool_offset.at[axis];
}

double takt_coordinates_to_parameter(double value, enum axis axis)
{
    return is_rotary(axis) ? value * DEGREES_PER_RAD : value;
}

double takt_coordinates_from_parameter(double value, enum axis axis)
{
    return is_rotary(axis) ? value * RAD_PER_DEGREE : value;
}

void takt_coordinates_set_turn(struct program_turn *turn, double degrees)
{
    turn->degrees = degrees;
    takt_maths_sincos(degrees * RAD_PER_DEGREE, &turn->sine, &turn->cosine);
}

void takt_coordinates_turn(const struct program_turn *turn, double *x, double *y)
{
    const double x_before = *x;

    if (turn->degrees != 0.0) {
        *x = x_before * turn->cosine - *y * turn->sine;
        *y = x_before * turn->sine + *y * turn->cosine;
    }
}

void takt_coordinates_turn_back(const struct program_turn *turn, double *x, double *y)
{
    const struct program_turn back = {-turn->degrees, -turn->sine, turn->cosine};

    takt_coordinates_turn(&back, x, y);
}

/* work = T^-1 (machine - system - tool) - axis offset */
void takt_coordinates_work_of(const struct program *p, const struct point *machine,
                              struct point *work)
{
    const struct program_modes *m = &p->modes;

    for (enum axis i = AXIS_X; i < AXIS_COUNT; i++) {
        work->at[i] = machine->at[i] - offset_of(p, i);
    }
    if (m->turn.degrees != 0.0) {
        for (enum axis i = AXIS_X; i <= AXIS_Y; i++) {
            work->at[i] += m->axis_offset.at[i];
        }
        takt_coordinates_turn_back(&m->turn, &work->at[AXIS_X], &work->at[AXIS_Y]);
        for (enum axis i = AXIS_X; i <= AXIS_Y; i++) {
            work->at[i] -= m->axis_offset.at[i];
        }
    }
}

void takt_coordinates_machine_of(const struct program *p, const struct point *work,
                                 struct point *machine)
{
    const struct program_modes *m = &p->modes;
    struct point from;
    double x = work->at[AXIS_X] + m->axis_offset.at[AXIS_X];
    double y = work->at[AXIS_Y] + m->axis_offset.at[AXIS_Y];

    takt_coordinates_work_of(p, &m->at, &from);
    *machine = m->at;
    for (enum axis i = AXIS_X; i < AXIS_COUNT; i++) {
        if (work->at[i] != from.at[i]) {
            machine->at[i] = work->at[i] + offset_of(p, i);
        }
    }
    if (m->turn.degrees != 0.0 &&
        (work->at[AXIS_X] != from.at[AXIS_X] || work->at[AXIS_Y] != from.at[AXIS_Y])) {
        takt_coordinates_turn(&m->turn, &x, &y);
        machine->at[AXIS_X] = x + m->system_offset.at[AXIS_X] + m->tool_offset.at[AXIS_X];
        machine->at[AXIS_Y] = y + m->system_offset.at[AXIS_Y] + m->tool_offset.at[AXIS_Y];
    }
}

double takt_coordinates_work(const struct program *p, enum axis axis)
{
    struct point work;

    TAKT_ASSERT(axis < AXIS_COUNT);
    takt_coordinates_work_of(p, &p->modes.at, &work);
    return is_rotary(axis) ? work.at[axis] * DEGREES_PER_RAD : work.at[axis] / p->modes.unit_mm;
}

bool takt_coordinates_word(const struct program *p, enum axis axis, double *value)
{
    const char letter = takt_coordinates_letter(axis);

    TAKT_ASSERT(axis < AXIS_COUNT);
    if (!words_has(p, letter)) {
        return false;
    }
    *value = words_value(p, letter) * (is_rotary(axis) ? RAD_PER_DEGREE : p->modes.unit_mm);
    if (axis == AXIS_X && p->modes.diameter) {
        *value *= 0.5;
    }
    return true;
}

/* The same through work coordinates: with a rotation a word moves both X and Y. */
static void rotated_end(const struct program *p, struct point *end)
{
    struct point work;
    double value;

    takt_coordinates_work_of(p, &p->modes.at, &work);
    for (enum axis i = AXIS_X; i < AXIS_COUNT; i++) {
        if (takt_coordinates_word(p, i, &value)) {
            work.at[i] = p->modes.incremental ? work.at[i] + value : value;
        }
    }
    takt_coordinates_machine_of(p, &work, end);
}

void takt_coordinates_end(const struct program *p, struct point *end)
{
    double value;

    if (p->modes.turn.degrees != 0.0 && !words_has_step(p, STEP_MACHINE)) {
        rotated_end(p, end);
        return;
    }
    *end = p->modes.at;
    for (enum axis i = AXIS_X; i < AXIS_COUNT; i++) {
        if (!takt_coordinates_word(p, i, &value)) {
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
        const double value = takt_parameters_get(p->config.parameters, first + i);

        point->at[i] = takt_coordinates_from_parameter(value, i);
    }
}

double takt_coordinates_system_offset(const struct program *p, unsigned system, enum axis axis)
{
    const unsigned first = PARAMETER_SYSTEM_OFFSET + (system - 1) * PARAMETER_SYSTEM_STRIDE;

    TAKT_ASSERT(system >= 1 && system <= COORDINATES_SYSTEMS && axis < AXIS_COUNT);
    return takt_coordinates_from_parameter(takt_parameters_get(p->config.parameters, first + axis),
                                           axis);
}

double takt_coordinates_system_degrees(const struct program *p, unsigned system)
{
    TAKT_ASSERT(system >= 1 && system <= COORDINATES_SYSTEMS);
    return takt_parameters_get(p->config.parameters,
                               PARAMETER_SYSTEM_ROTATE + (system - 1) * PARAMETER_SYSTEM_STRIDE);
}

void takt_coordinates_load_system(struct program *p, unsigned system)
{
    TAKT_ASSERT(system >= 1 && system <= COORDINATES_SYSTEMS);
    p->modes.system = (uint8_t)system;
    for (enum axis i = AXIS_X; i < AXIS_COUNT; i++) {
        p->modes.system_offset.at[i] = takt_coordinates_system_offset(p, system, i);
    }
    takt_coordinates_set_turn(&p->modes.turn, takt_coordinates_system_degrees(p, system));
}

void takt_coordinates_open(struct program *p)
{
    const double system = takt_parameters_get(p->config.parameters, PARAMETER_SYSTEM);
    const bool known = system >= 1.0 && system <= COORDINATES_SYSTEMS;

    if (!known) {
        (void)takt_parameters_set(p->config.parameters, PARAMETER_SYSTEM, 1.0);
    }
    takt_coordinates_load_system(p, known ? (unsigned)system : 1U);
    if (takt_parameters_get(p->config.parameters, PARAMETER_AXIS_APPLIED) != 0.0) {
        point_from_parameters(p, PARAMETER_AXIS_OFFSET, &p->modes.axis_offset);
    }
}

void takt_coordinates_reload(struct program *p)
{
    memset(&p->modes.axis_offset, 0, sizeof(p->modes.axis_offset));
    takt_coordinates_open(p);
}

/* The system in use already is not loaded again, as in LinuxCNC. */
bool takt_coordinates_select(struct program *p, const struct program_code *code)
{
    const unsigned system = (unsigned)code->argument;

    if (system != p->modes.system) {
        takt_coordinates_load_system(p, system);
    }
    return takt_words_store(p, code->step, PARAMETER_SYSTEM, system);
}

/* G92: the current position gets the coordinates of the words. G52: the words are the offset. */
bool takt_coordinates_set_axis_offset(struct program *p, const struct program_code *code)
{
    struct program_modes *m = &p->modes;
    struct point work;
    double value;

    if ((p->words.given & LETTERS_AXES) == 0) {
        return takt_report_error_code(p, TAKT_ERROR_AXIS_WORD_MISSING, code->step, 0.0);
    }
    takt_coordinates_work_of(p, &m->at, &work);
    for (enum axis i = AXIS_X; i < AXIS_COUNT; i++) {
        if (takt_coordinates_word(p, i, &value)) {
            m->axis_offset.at[i] =
                code->argument == 1 ? value : work.at[i] + m->axis_offset.at[i] - value;
        }
        if (!takt_words_store(p, code->step, PARAMETER_AXIS_OFFSET + i,
                              takt_coordinates_to_parameter(m->axis_offset.at[i], i))) {
            return false;
        }
    }
    return takt_words_store(p, code->step, PARAMETER_AXIS_APPLIED, 1.0);
}

bool takt_coordinates_cancel_axis_offset(struct program *p, const struct program_code *code)
{
    memset(&p->modes.axis_offset, 0, sizeof(p->modes.axis_offset));
    for (enum axis i = AXIS_X; code->argument == 1 && i < AXIS_COUNT; i++) {
        if (!takt_words_store(p, code->step, PARAMETER_AXIS_OFFSET + i, 0.0)) {
            return false;
        }
    }
    return takt_words_store(p, code->step, PARAMETER_AXIS_APPLIED, 0.0);
}

bool takt_coordinates_restore_axis_offset(struct program *p, const struct program_code *code)
{
    point_from_parameters(p, PARAMETER_AXIS_OFFSET, &p->modes.axis_offset);
    return takt_words_store(p, code->step, PARAMETER_AXIS_APPLIED, 1.0);
}

/*
 * The offset of tool H, or else of the one in the spindle, which H0 names too. An unknown tool
 * other than "no tool" is worth a warning.
 */
static bool offset_of_tool(struct program *p, const struct program_code *code, struct point *offset)
{
    uint32_t number = p->modes.tool_current;
    struct program_span span = p->words.code_span[code->step];

    if (words_has(p, 'h')) {
        if (!takt_words_whole(p, 'h', 0.0, PROGRAM_TOOL_MAX, &number)) {
            return false;
        }
        span = p->words.span[LETTER_INDEX('h')];
        number = number == 0 ? p->modes.tool_current : number;
    }
    const struct tool *tool = takt_tool_values_find(p, number);

    if (tool != NULL) {
        *offset = tool->offset;
        return true;
    }
    memset(offset, 0, sizeof(*offset));
    if (number != 0) {
        takt_report_warning(p, TAKT_ERROR_TOOL_UNKNOWN, span, number);
    }
    return true;
}

bool takt_coordinates_use_tool(struct program *p, const struct program_code *code)
{
    return offset_of_tool(p, code, &p->modes.tool_offset);
}

bool takt_coordinates_set_tool_offset(struct program *p, const struct program_code *code)
{
    (void)code;
    for (enum axis i = AXIS_X; i < AXIS_COUNT; i++) {
        (void)takt_coordinates_word(p, i, &p->modes.tool_offset.at[i]);
    }
    return true;
}

bool takt_coordinates_add_tool_offset(struct program *p, const struct program_code *code)
{
    const bool axes = (p->words.given & LETTERS_AXES) != 0;
    struct point offset = {{0.0}};

    if (words_has(p, 'h') && axes) {
        return takt_report_error_letter(p, TAKT_ERROR_WORD_UNUSED, 'h', 0.0);
    }
    if (!words_has(p, 'h') && !axes) {
        return takt_report_error_code(p, TAKT_ERROR_SETTING_MISSING, code->step, 0.0);
    }
    if (words_has(p, 'h') && !offset_of_tool(p, code, &offset)) {
        return false;
    }
    for (enum axis i = AXIS_X; i < AXIS_COUNT; i++) {
        (void)takt_coordinates_word(p, i, &offset.at[i]);
        p->modes.tool_offset.at[i] += offset.at[i];
    }
    return true;
}

bool takt_coordinates_drop_tool(struct program *p, const struct program_code *code)
{
    (void)code;
    memset(&p->modes.tool_offset, 0, sizeof(p->modes.tool_offset));
    return true;
}

/* G0 or G1. */
static bool is_straight(const struct program *p)
{
    return words_has_step(p, STEP_MOTION) && p->words.code[STEP_MOTION]->run == takt_straight_move;
}

/* G0 or G1 is in effect, but the line has nothing that would go on with it. */
static bool misses_axes(const struct program *p)
{
    return !words_has_step(p, STEP_MOTION) && p->modes.motion != NULL &&
           p->modes.motion->run == takt_straight_move;
}

bool takt_coordinates_use_machine(struct program *p, const struct program_code *code)
{
    if (!p->modes.incremental && misses_axes(p)) {
        return takt_report_error_code(p, TAKT_ERROR_AXIS_WORD_MISSING, code->step, 0.0);
    }
    if (p->modes.incremental || !is_straight(p)) {
        return takt_report_error_code(p, TAKT_ERROR_MACHINE_COORDINATES, code->step, 0.0);
    }
    return true;
}
