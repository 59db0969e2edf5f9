#include "program/events.h"

#include "program/emit.h"
#include "program/report.h"
#include "program/words.h"

static void emit_spindle(struct program *p)
{
    struct move *m = emit_event(p, MOVE_SPINDLE);

    m->direction = p->modes.direction;
    m->speed_rpm = p->modes.direction == SPINDLE_OFF ? 0.0 : p->modes.speed_rpm;
}

/* The spindle hears of a new speed at once, unless a word of this line turns it anyway or it stands. */
bool events_set_speed(struct program *p, const struct program_code *code)
{
    double speed_rpm = words_value(p, 's');
    const double max_rpm = p->config.spindle_max_rpm;

    (void)code;
    if (speed_rpm < 0.0) {
        return report_error_letter(p, TAKT_ERROR_WORD_NEGATIVE, 's', speed_rpm);
    }
    if (max_rpm > 0.0 && speed_rpm > max_rpm) {
        report_warning(p, TAKT_ERROR_SPINDLE_LIMITED, p->words.span[LETTER_INDEX('s')], max_rpm);
        speed_rpm = max_rpm;
    }
    p->modes.speed_rpm = speed_rpm;
    if (p->modes.direction != SPINDLE_OFF && !words_has_step(p, STEP_SPINDLE)) {
        emit_spindle(p);
    }
    return true;
}

bool events_select_tool(struct program *p, const struct program_code *code)
{
    (void)code;
    if (!words_whole(p, 't', 0.0, PROGRAM_TOOL_MAX, &p->modes.tool_selected)) {
        return false;
    }
    p->modes.tool_is_selected = true;
    emit_event(p, MOVE_TOOL)->tool = p->modes.tool_selected;
    return true;
}

/* Nobody changes a tool that turns. */
bool events_change_tool(struct program *p, const struct program_code *code)
{
    if (!p->modes.tool_is_selected) {
        return report_error_code(p, TAKT_ERROR_TOOL_MISSING, code->step, 0.0);
    }
    if (p->modes.direction != SPINDLE_OFF) {
        p->modes.direction = SPINDLE_OFF;
        emit_spindle(p);
    }
    struct move *m = emit_event(p, MOVE_TOOL);

    m->tool = p->modes.tool_selected;
    m->tool_change = true;
    p->modes.tool_current = p->modes.tool_selected;
    return true;
}

bool events_turn_spindle(struct program *p, const struct program_code *code)
{
    p->modes.direction = (enum spindle_direction)code->argument;
    emit_spindle(p);
    return true;
}

bool events_set_coolant(struct program *p, const struct program_code *code)
{
    struct program_modes *modes = &p->modes;

    modes->mist = code->argument == COOLANT_MIST || (modes->mist && code->argument != COOLANT_OFF);
    modes->flood =
        code->argument == COOLANT_FLOOD || (modes->flood && code->argument != COOLANT_OFF);
    struct move *m = emit_event(p, MOVE_COOLANT);

    m->mist = modes->mist;
    m->flood = modes->flood;
    return true;
}

bool events_dwell(struct program *p, const struct program_code *code)
{
    if (!words_has(p, 'p')) {
        return report_error_code(p, TAKT_ERROR_DWELL_MISSING, code->step, 0.0);
    }
    const double seconds = words_value(p, 'p');

    if (seconds < 0.0) {
        return report_error_letter(p, TAKT_ERROR_WORD_NEGATIVE, 'p', seconds);
    }
    emit_event(p, MOVE_DWELL)->dwell_s = seconds;
    return true;
}

bool events_stop(struct program *p, const struct program_code *code)
{
    emit_event(p, MOVE_STOP)->optional = code->argument == 1;
    return true;
}

/* The next program starts in G54 again. */
bool events_end(struct program *p, const struct program_code *code)
{
    if (!words_store(p, code->step, PARAMETER_SYSTEM, 1.0)) {
        return false;
    }
    emit_event(p, MOVE_END);
    p->phase = PROGRAM_ENDED;
    return true;
}
