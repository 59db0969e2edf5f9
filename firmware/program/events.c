#include "program/events.h"

#include "base/assert.h"
#include "base/maths.h"
#include "program/coordinates.h"
#include "program/emit.h"
#include "program/report.h"
#include "program/words.h"

#define MM_PER_M           1000.0
#define MM_PER_FOOT        304.8
#define SECONDS_PER_MINUTE 60.0
#define DEGREES_MAX        360.0
#define RAD_PER_DEGREE     (MATHS_PI / 180.0)

/* Machine position of X 0, about which a lathe's part turns. */
static double axis_x_mm(const struct program *p)
{
    struct point work;
    struct point machine;

    takt_coordinates_work_of(p, &p->modes.at, &work);
    work.at[AXIS_X] = 0.0;
    takt_coordinates_machine_of(p, &work, &machine);
    return machine.at[AXIS_X];
}

void takt_events_spindle_move(const struct program *p, enum spindle_direction direction,
                              struct move *m)
{
    const struct program_modes *modes = &p->modes;

    TAKT_ASSERT(m->kind == MOVE_SPINDLE);
    m->direction = direction;
    if (direction == SPINDLE_OFF) {
        return;
    }
    m->speed_rpm = modes->surface_speed ? modes->surface_max_rpm : modes->speed_rpm;
    if (modes->surface_speed) {
        m->surface_mm_s = modes->surface_mm_s;
        m->surface_x_mm = axis_x_mm(p);
    }
}

void takt_events_tell_spindle(struct program *p)
{
    takt_events_spindle_move(p, p->modes.direction, takt_emit_event(p, MOVE_SPINDLE));
}

/* The line has code but not the word it needs. */
static bool lacks(struct program *p, const struct program_code *code, char letter)
{
    return !words_has(p, letter) && !takt_report_missing(p, code->step, letter);
}

/* S with G96: m/min, or feet/min after G20. */
static void set_surface_speed(struct program *p, double speed)
{
    const double unit_mm = p->modes.unit_mm == 1.0 ? MM_PER_M : MM_PER_FOOT;

    p->modes.surface_mm_s = speed * unit_mm / SECONDS_PER_MINUTE;
}

static void set_speed(struct program *p, double speed_rpm)
{
    const double max_rpm = p->config.spindle_max_rpm;

    if (max_rpm > 0.0 && speed_rpm > max_rpm) {
        takt_report_warning(p, TAKT_ERROR_SPINDLE_LIMITED, p->words.span[LETTER_INDEX('s')],
                            max_rpm);
        speed_rpm = max_rpm;
    }
    p->modes.speed_rpm = speed_rpm;
}

/* The lower of D and the machine's maximum. */
static double surface_maximum(const struct program *p)
{
    const double machine_rpm = p->config.spindle_max_rpm;
    const double given_rpm = words_has(p, 'd') ? maths_abs(words_value(p, 'd')) : 0.0;

    if (given_rpm == 0.0 || machine_rpm == 0.0) {
        return maths_max(given_rpm, machine_rpm);
    }
    return maths_min(given_rpm, machine_rpm);
}

/* Without S on the line, G97 goes on with the last S that was rev/min. */
bool takt_events_set_spindle_mode(struct program *p, const struct program_code *code)
{
    p->modes.surface_speed = code->argument == 1;
    if (p->modes.surface_speed) {
        p->modes.surface_max_rpm = surface_maximum(p);
        return !lacks(p, code, 's');
    }
    if (p->modes.direction != SPINDLE_OFF && !words_has(p, 's') &&
        !words_has_step(p, STEP_SPINDLE)) {
        takt_events_tell_spindle(p);
    }
    return true;
}

/*
 * The spindle hears of a new speed at once, unless a word of this line turns it anyway or it
 * stands.
 */
bool takt_events_set_speed(struct program *p, const struct program_code *code)
{
    const double speed = words_value(p, 's');

    (void)code;
    if (speed < 0.0) {
        return takt_report_error_letter(p, TAKT_ERROR_WORD_NEGATIVE, 's', speed);
    }
    if (p->modes.surface_speed) {
        set_surface_speed(p, speed);
    } else {
        set_speed(p, speed);
    }
    if (p->modes.direction != SPINDLE_OFF && !words_has_step(p, STEP_SPINDLE)) {
        takt_events_tell_spindle(p);
    }
    return true;
}

bool takt_events_select_tool(struct program *p, const struct program_code *code)
{
    (void)code;
    if (!takt_words_whole(p, 't', 0.0, PROGRAM_TOOL_MAX, &p->modes.tool_selected)) {
        return false;
    }
    p->modes.tool_is_selected = true;
    takt_emit_event(p, MOVE_TOOL)->tool = p->modes.tool_selected;
    return true;
}

/* Nobody changes a tool that turns. */
bool takt_events_change_tool(struct program *p, const struct program_code *code)
{
    if (!p->modes.tool_is_selected) {
        return takt_report_error_code(p, TAKT_ERROR_TOOL_MISSING, code->step, 0.0);
    }
    if (p->modes.direction != SPINDLE_OFF) {
        p->modes.direction = SPINDLE_OFF;
        takt_events_tell_spindle(p);
    }
    struct move *m = takt_emit_event(p, MOVE_TOOL);

    m->tool = p->modes.tool_selected;
    m->tool_change = true;
    p->modes.tool_current = p->modes.tool_selected;
    return true;
}

bool takt_events_load_tool(struct program *p, const struct program_code *code)
{
    if (lacks(p, code, 'q') ||
        !takt_words_whole(p, 'q', 0.0, PROGRAM_TOOL_MAX, &p->modes.tool_current)) {
        return false;
    }
    struct move *m = takt_emit_event(p, MOVE_TOOL);

    m->tool = p->modes.tool_current;
    m->tool_loaded = true;
    return true;
}

/* Without R and P it only stops. */
bool takt_events_orient_spindle(struct program *p, const struct program_code *code)
{
    const double degrees = words_has(p, 'r') ? words_value(p, 'r') : 0.0;
    const double timeout_s = words_has(p, 'q') ? words_value(p, 'q') : 0.0;
    uint32_t way = ORIENT_SHORTEST;

    (void)code;
    if (!words_has(p, 'r') && !words_has(p, 'p')) {
        p->modes.direction = SPINDLE_OFF;
        takt_events_tell_spindle(p);
        return true;
    }
    if (degrees < 0.0 || degrees > DEGREES_MAX) {
        return takt_report_error_letter(p, TAKT_ERROR_WORD_OUT_OF_RANGE, 'r', degrees);
    }
    if (words_has(p, 'p') && !takt_words_whole(p, 'p', ORIENT_SHORTEST, ORIENT_CCW, &way)) {
        return false;
    }
    if (words_has(p, 'q') && timeout_s <= 0.0) {
        return takt_report_error_letter(p, TAKT_ERROR_WORD_NOT_POSITIVE, 'q', timeout_s);
    }
    struct move *m = takt_emit_event(p, MOVE_ORIENT);

    m->orient_rad = degrees * RAD_PER_DEGREE;
    m->orient_way = (enum orient_way)way;
    m->timeout_s = timeout_s;
    p->modes.direction = SPINDLE_OFF;
    return true;
}

bool takt_events_set_output(struct program *p, const struct program_code *code)
{
    const bool analogue = (code->argument & OUTPUT_ANALOGUE) != 0;
    const char letter = analogue ? 'e' : 'p';
    const double highest = analogue ? PROGRAM_ANALOGUE_MAX : PROGRAM_DIGITAL_MAX;
    uint32_t channel;

    if (lacks(p, code, letter) || !takt_words_whole(p, letter, 0.0, highest, &channel) ||
        (analogue && lacks(p, code, 'q'))) {
        return false;
    }
    struct move *m = takt_emit_event(p, MOVE_OUTPUT);

    m->channel = channel;
    m->analogue = analogue;
    m->with_motion = (code->argument & OUTPUT_WITH_MOTION) != 0;
    m->output = analogue ? words_value(p, 'q') : (code->argument & OUTPUT_ON) != 0 ? 1.0 : 0.0;
    return true;
}

/* L and Q of M66. */
static bool read_wait(struct program *p, const struct program_code *code, uint32_t *wait,
                      double *timeout_s)
{
    const double highest = words_has(p, 'e') ? INPUT_READ : INPUT_LOW;

    *wait = INPUT_READ;
    *timeout_s = words_has(p, 'q') ? words_value(p, 'q') : 0.0;
    if (words_has(p, 'l') && !takt_words_whole(p, 'l', INPUT_READ, highest, wait)) {
        return false;
    }
    if (*wait == INPUT_READ || *timeout_s > 0.0) {
        return true;
    }
    return !lacks(p, code, 'q') &&
           takt_report_error_letter(p, TAKT_ERROR_WORD_NOT_POSITIVE, 'q', *timeout_s);
}

/* The input is 0 (#5399) until takt_program_answer says what it is. */
bool takt_events_read_input(struct program *p, const struct program_code *code)
{
    const bool analogue = words_has(p, 'e');
    const char letter = analogue ? 'e' : 'p';
    const double highest = analogue ? PROGRAM_ANALOGUE_MAX : PROGRAM_DIGITAL_MAX;
    uint32_t channel;
    uint32_t wait;
    double timeout_s;

    if (analogue && words_has(p, 'p')) {
        return takt_report_error_letter(p, TAKT_ERROR_WORD_UNUSED, 'p', 0.0);
    }
    if (lacks(p, code, letter) || !takt_words_whole(p, letter, 0.0, highest, &channel) ||
        !read_wait(p, code, &wait, &timeout_s)) {
        return false;
    }
    struct move *m = takt_emit_event(p, MOVE_INPUT);

    m->channel = channel;
    m->analogue = analogue;
    m->input_wait = (enum input_wait)wait;
    m->timeout_s = timeout_s;
    return takt_words_store(p, code->step, PARAMETER_INPUT, 0.0);
}

bool takt_events_turn_spindle(struct program *p, const struct program_code *code)
{
    p->modes.direction = (enum spindle_direction)code->argument;
    takt_events_tell_spindle(p);
    return true;
}

void takt_events_tell_coolant(struct program *p)
{
    struct move *m = takt_emit_event(p, MOVE_COOLANT);

    m->mist = p->modes.mist;
    m->flood = p->modes.flood;
}

bool takt_events_set_coolant(struct program *p, const struct program_code *code)
{
    struct program_modes *modes = &p->modes;

    modes->mist = code->argument == COOLANT_MIST || (modes->mist && code->argument != COOLANT_OFF);
    modes->flood =
        code->argument == COOLANT_FLOOD || (modes->flood && code->argument != COOLANT_OFF);
    takt_events_tell_coolant(p);
    return true;
}

bool takt_events_dwell(struct program *p, const struct program_code *code)
{
    if (!words_has(p, 'p')) {
        return takt_report_error_code(p, TAKT_ERROR_DWELL_MISSING, code->step, 0.0);
    }
    const double seconds = words_value(p, 'p');

    if (seconds < 0.0) {
        return takt_report_error_letter(p, TAKT_ERROR_WORD_NEGATIVE, 'p', seconds);
    }
    takt_emit_event(p, MOVE_DWELL)->dwell_s = seconds;
    return true;
}

bool takt_events_stop(struct program *p, const struct program_code *code)
{
    takt_emit_event(p, MOVE_STOP)->optional = code->argument == 1;
    return true;
}

/* The next program starts in G54 again. */
bool takt_events_end(struct program *p, const struct program_code *code)
{
    if (!takt_words_store(p, code->step, PARAMETER_SYSTEM, 1.0)) {
        return false;
    }
    takt_emit_event(p, MOVE_END);
    p->phase = PROGRAM_ENDED;
    return true;
}
