#include "program/setting.h"

#include "base/assert.h"
#include "base/maths.h"
#include "program/coordinates.h"
#include "program/emit.h"
#include "program/report.h"
#include "program/tool_values.h"
#include "program/words.h"

/* The coordinate system of L11: G59.3. */
#define FIXTURE_SYSTEM 9

#define DEGREES_PER_RAD (180.0 / MATHS_PI)

/* mm, s: of a tool. */
#define WEAR_MAX 1e9

enum what {
    TOOLS_AGAIN = 0, /* the table is read again: it is what it was */
    TOOL = 1,
    SYSTEM = 2,
    TOOL_BY_POSITION = 10,
    TOOL_BY_FIXTURE = 11,
    WEAR = 12,  /* takt's own */
    SETUP = 13, /* takt's own */
    SYSTEM_BY_POSITION = 20
};

/* letters: bit 0 is A. */
static bool refuse_words(struct program *p, uint32_t letters)
{
    for (unsigned i = 0; i <= 'z' - 'a'; i++) {
        const char letter = (char)('a' + i);

        if ((letters & LETTER_BIT(letter)) != 0 && words_has(p, letter)) {
            return takt_report_error_letter(p, TAKT_ERROR_WORD_UNUSED, letter, 0.0);
        }
    }
    return true;
}

/*
 * Work coordinates that the current position has in a coordinate system, without a tool offset:
 *
 *     work = T^-1 (machine - system) - axis offset
 */
static void work_in_system(const struct program *p, unsigned system,
                           const struct program_turn *turn, struct point *work)
{
    for (enum axis i = AXIS_X; i < AXIS_COUNT; i++) {
        work->at[i] = p->modes.at.at[i] - takt_coordinates_system_offset(p, system, i);
    }
    takt_coordinates_turn_back(turn, &work->at[AXIS_X], &work->at[AXIS_Y]);
    for (enum axis i = AXIS_X; i < AXIS_COUNT; i++) {
        work->at[i] -= p->modes.axis_offset.at[i];
    }
}

static bool store_offset(struct program *p, enum step step, unsigned system, enum axis axis,
                         double offset)
{
    const unsigned first = PARAMETER_SYSTEM_OFFSET + (system - 1) * PARAMETER_SYSTEM_STRIDE;

    TAKT_ASSERT(system >= 1 && system <= COORDINATES_SYSTEMS && axis < AXIS_COUNT);
    return takt_words_store(p, step, first + axis, takt_coordinates_to_parameter(offset, axis));
}

static bool set_system(struct program *p, enum step step, unsigned system)
{
    const unsigned rotate = PARAMETER_SYSTEM_ROTATE + (system - 1) * PARAMETER_SYSTEM_STRIDE;
    double value;

    TAKT_ASSERT(system >= 1 && system <= COORDINATES_SYSTEMS);
    for (enum axis i = AXIS_X; i < AXIS_COUNT; i++) {
        if (takt_coordinates_word(p, i, &value) && !store_offset(p, step, system, i, value)) {
            return false;
        }
    }
    return !words_has(p, 'r') || takt_words_store(p, step, rotate, words_value(p, 'r'));
}

/*
 * The offset with which the current position gets the coordinates w of the words. With those it has
 * now, u, that is
 *
 *     new offset = old offset + T (u - w)
 *
 * where u - w is 0 for an axis without a word.
 */
static bool set_system_by_position(struct program *p, enum step step, unsigned system)
{
    struct point machine = p->modes.at;
    struct point change = {{0.0}};
    struct program_turn turn;
    double value;

    if (!refuse_words(p, LETTER_BIT('r'))) {
        return false;
    }
    takt_coordinates_set_turn(&turn, takt_coordinates_system_degrees(p, system));
    work_in_system(p, system, &turn, &machine);
    struct point tool = p->modes.tool_offset;

    takt_coordinates_turn_back(&turn, &tool.at[AXIS_X], &tool.at[AXIS_Y]);
    for (enum axis i = AXIS_X; i < AXIS_COUNT; i++) {
        if (takt_coordinates_word(p, i, &value)) {
            change.at[i] = machine.at[i] - tool.at[i] - value;
        }
    }
    takt_coordinates_turn(&turn, &change.at[AXIS_X], &change.at[AXIS_Y]);
    for (enum axis i = AXIS_X; i < AXIS_COUNT; i++) {
        const double old = takt_coordinates_system_offset(p, system, i);

        if (change.at[i] != 0.0 && !store_offset(p, step, system, i, old + change.at[i])) {
            return false;
        }
    }
    return true;
}

/* P is a coordinate system, 0 the one in use. */
static bool run_system(struct program *p, const struct program_code *code, bool by_position)
{
    uint32_t system;

    if (!refuse_words(p, LETTER_BIT('i') | LETTER_BIT('j') | LETTER_BIT('k') | LETTER_BIT('q')) ||
        !takt_words_whole(p, 'p', 0.0, COORDINATES_SYSTEMS, &system)) {
        return false;
    }
    if (system == 0) {
        system = p->modes.system;
    }
    if (!(by_position ? set_system_by_position(p, code->step, system)
                      : set_system(p, code->step, system))) {
        return false;
    }
    if (system == p->modes.system) {
        takt_coordinates_load_system(p, system);
    }
    return true;
}

static void set_offsets(const struct program *p, struct tool *tool)
{
    double value;

    for (enum axis i = AXIS_X; i < AXIS_COUNT; i++) {
        if (takt_coordinates_word(p, i, &value)) {
            tool->offset.at[i] = value;
        }
    }
}

/*
 * Seen along the axes of the system, the offset of an axis with a word is what the position exceeds
 * the word by.
 */
static void set_offsets_by_position(const struct program *p, unsigned system, bool axis_offset,
                                    struct tool *tool)
{
    struct program_turn turn;
    struct point work;
    double value;

    takt_coordinates_set_turn(&turn, takt_coordinates_system_degrees(p, system));
    work_in_system(p, system, &turn, &work);
    takt_coordinates_turn_back(&turn, &tool->offset.at[AXIS_X], &tool->offset.at[AXIS_Y]);
    for (enum axis i = AXIS_X; i < AXIS_COUNT; i++) {
        if (takt_coordinates_word(p, i, &value)) {
            tool->offset.at[i] =
                work.at[i] + (axis_offset ? 0.0 : p->modes.axis_offset.at[i]) - value;
        }
    }
    takt_coordinates_turn(&turn, &tool->offset.at[AXIS_X], &tool->offset.at[AXIS_Y]);
}

static void set_shape(const struct program *p, struct tool *tool, uint32_t orientation)
{
    if (words_has(p, 'r')) {
        tool->diameter_mm = 2.0 * words_value(p, 'r') * p->modes.unit_mm;
    }
    if (words_has(p, 'i')) {
        tool->front_angle_deg = words_value(p, 'i');
    }
    if (words_has(p, 'j')) {
        tool->back_angle_deg = words_value(p, 'j');
    }
    if (words_has(p, 'q')) {
        tool->orientation = orientation;
    }
}

static bool run_tool(struct program *p, const struct program_code *code, enum what what)
{
    const uint32_t setting =
        LETTERS_AXES | LETTER_BIT('i') | LETTER_BIT('j') | LETTER_BIT('q') | LETTER_BIT('r');
    uint32_t number;
    uint32_t orientation = 0;

    if (!refuse_words(p, LETTER_BIT('k')) ||
        !takt_words_whole(p, 'p', 1.0, PROGRAM_TOOL_MAX, &number) ||
        (words_has(p, 'q') &&
         !takt_words_whole(p, 'q', 0.0, CUTTER_ORIENTATION_MAX, &orientation))) {
        return false;
    }
    if ((p->words.given & setting) == 0) {
        return takt_report_error_code(p, TAKT_ERROR_SETTING_MISSING, code->step, 0.0);
    }
    struct tool *tool = takt_tool_values_change(p, code->step, number);

    if (tool == NULL) {
        return false;
    }
    if (what == TOOL) {
        set_offsets(p, tool);
    } else {
        const bool fixture = what == TOOL_BY_FIXTURE;

        set_offsets_by_position(p, fixture ? FIXTURE_SYSTEM : p->modes.system, !fixture, tool);
    }
    set_shape(p, tool, orientation);
    return true;
}

/*
 * What a tool has cut since it was new, for the wear of the position correction: I whole mm, J
 * whole s, else 0.
 */
static bool run_wear(struct program *p, const struct program_code *code)
{
    uint32_t number, length_mm = 0, time_s = 0;

    if (!refuse_words(p, LETTERS_AXES | LETTER_BIT('k') | LETTER_BIT('q') | LETTER_BIT('r')) ||
        !takt_words_whole(p, 'p', 1.0, PROGRAM_TOOL_MAX, &number) ||
        (words_has(p, 'i') && !takt_words_whole(p, 'i', 0.0, WEAR_MAX, &length_mm)) ||
        (words_has(p, 'j') && !takt_words_whole(p, 'j', 0.0, WEAR_MAX, &time_s))) {
        return false;
    }
    if (takt_tool_values_find(p, number) == NULL) {
        return takt_report_error_code(p, TAKT_ERROR_TOOL_ABSENT, code->step, number);
    }
    struct move *m = takt_emit_event(p, MOVE_WEAR);

    m->tool = number;
    m->wear_length_mm = length_mm;
    m->wear_time_s = time_s;
    return true;
}

static struct move *emit_setup(struct program *p, unsigned which, double value)
{
    struct move *m = takt_emit_event(p, MOVE_SETUP);

    TAKT_ASSERT(which < MOVE_SETUP_VALUES);
    m->channel = which;
    m->setup = value;
    return m;
}

/* The set-up of the part, for the position correction. What has no word stays. */
static bool run_setup(struct program *p)
{
    static const char turns[] = {'i', 'j', 'k', 'r'};
    struct move *last = NULL;
    double value;

    if (!refuse_words(p, LETTER_BIT('a') | LETTER_BIT('b') | LETTER_BIT('c') | LETTER_BIT('p') |
                             LETTER_BIT('q'))) {
        return false;
    }
    for (unsigned i = AXIS_X; i < AXIS_LINEAR_COUNT; i++) {
        if (takt_coordinates_word(p, (enum axis)i, &value)) {
            last = emit_setup(p, i, value);
        }
    }
    for (unsigned i = 0; i < sizeof(turns); i++) {
        if (words_has(p, turns[i])) {
            last = emit_setup(p, AXIS_LINEAR_COUNT + i, words_value(p, turns[i]) / DEGREES_PER_RAD);
        }
    }
    if (last != NULL) {
        last->setup_ends = true;
    }
    return true;
}

bool takt_setting_run(struct program *p, const struct program_code *code)
{
    uint32_t what;

    if (!words_has(p, 'l')) {
        return takt_report_missing(p, code->step, 'l');
    }
    if (!takt_words_whole(p, 'l', TOOLS_AGAIN, SYSTEM_BY_POSITION, &what)) {
        return false;
    }
    if (what != TOOLS_AGAIN && what != SETUP && !words_has(p, 'p')) {
        return takt_report_missing(p, code->step, 'p');
    }
    switch (what) {
    case TOOLS_AGAIN:
        return true;
    case SYSTEM:
    case SYSTEM_BY_POSITION:
        return run_system(p, code, what == SYSTEM_BY_POSITION);
    case TOOL:
    case TOOL_BY_POSITION:
    case TOOL_BY_FIXTURE:
        return run_tool(p, code, (enum what)what);
    case WEAR:
        return run_wear(p, code);
    case SETUP:
        return run_setup(p);
    default:
        return takt_report_error_letter(p, TAKT_ERROR_WORD_OUT_OF_RANGE, 'l', what);
    }
}
