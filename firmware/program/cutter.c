#include "program/cutter.h"

#include "program/report.h"
#include "program/tool_values.h"
#include "program/words.h"

#include <string.h>

/* For a tool that is guided by its centre, even if it is a turning tool. */
#define ORIENTATION_CENTRE 9

static bool is_on(const struct program *p)
{
    return p->modes.cutter_side != CUTTER_OFF;
}

/*
 * A contour has been left: the tool is beside the programmed point, so the next move cannot be an
 * arc.
 */
bool takt_cutter_cancel(struct program *p, const struct program_code *code)
{
    (void)code;
    p->modes.cutter_left = is_on(p) && p->modes.cutter_moved;
    p->modes.cutter_side = CUTTER_OFF;
    p->modes.cutter_radius_mm = 0.0;
    p->modes.cutter_code = NULL;
    return true;
}

/* What the plane has to do with it. span: what brought the orientation. */
static bool check_plane(struct program *p, const struct program_code *code, uint32_t orientation,
                        struct program_span span)
{
    const bool led_aside = orientation != 0 && orientation != ORIENTATION_CENTRE;

    if (p->modes.turn.degrees != 0.0 && p->modes.plane != PLANE_XY) {
        return takt_report_error_code(p, TAKT_ERROR_ARC_TILTED, code->step, p->modes.turn.degrees);
    }
    return !led_aside || p->modes.plane == PLANE_ZX ||
           takt_report_error(p, TAKT_ERROR_CUTTER_ORIENTATION, span, orientation);
}

/* A negative diameter changes the side. */
static bool turn_on(struct program *p, const struct program_code *code, double diameter_mm,
                    uint32_t orientation, struct program_span span)
{
    const bool left = (code->argument == CUTTER_LEFT) == (diameter_mm >= 0.0);

    if (is_on(p)) {
        return takt_report_error_code(p, TAKT_ERROR_CUTTER_REPEATED, code->step, 0.0);
    }
    if (!check_plane(p, code, orientation, span)) {
        return false;
    }
    p->modes.cutter_side = left ? CUTTER_LEFT : CUTTER_RIGHT;
    p->modes.cutter_radius_mm = 0.5 * (diameter_mm < 0.0 ? -diameter_mm : diameter_mm);
    p->modes.cutter_orientation = (uint8_t)orientation;
    p->modes.cutter_code = code;
    p->modes.cutter_moved = false;
    return true;
}

/* The tool in the spindle, T0, has no radius: nothing is then compensated. */
bool takt_cutter_use_tool(struct program *p, const struct program_code *code)
{
    uint32_t number = p->modes.tool_current;
    struct program_span span = p->words.code_span[code->step];

    if (words_has(p, 'd')) {
        if (!takt_words_whole(p, 'd', 0.0, PROGRAM_TOOL_MAX, &number)) {
            return false;
        }
        span = p->words.span[LETTER_INDEX('d')];
    }
    const struct tool *tool = takt_tool_values_find(p, number);

    if (tool == NULL && number != 0) {
        return takt_report_error(p, TAKT_ERROR_TOOL_ABSENT, span, number);
    }
    return tool == NULL ? turn_on(p, code, 0.0, 0, span)
                        : turn_on(p, code, tool->diameter_mm, tool->orientation, span);
}

bool takt_cutter_use_diameter(struct program *p, const struct program_code *code)
{
    uint32_t orientation = 0;

    if (!words_has(p, 'd')) {
        return takt_report_error_code(p, TAKT_ERROR_CUTTER_DIAMETER, code->step, 0.0);
    }
    if (words_has(p, 'l') && !takt_words_whole(p, 'l', 0.0, CUTTER_ORIENTATION_MAX, &orientation)) {
        return false;
    }
    return turn_on(p, code, words_value(p, 'd') * p->modes.unit_mm, orientation,
                   p->words.span[LETTER_INDEX('l')]);
}

/* Among the motions G0 to G3, G2.2 and G3.2 can be compensated; G80 moves nothing. */
static bool is_compensable(const struct program_code *code)
{
    static const uint16_t numbers_x10[] = {0, 10, 20, 22, 30, 32, 700, 800};

    for (unsigned i = 0; i < sizeof(numbers_x10) / sizeof(numbers_x10[0]); i++) {
        if (code->number_x10 == numbers_x10[i]) {
            return true;
        }
    }
    return false;
}

/* LinuxCNC's rules, but for G10: that may change what the contour does not use. */
static bool is_forbidden(const struct program *p, const struct program_code *code)
{
    static const uint32_t forbidden =
        UINT32_C(1) << STEP_CHANNEL | UINT32_C(1) << STEP_TOOL_CHANGE |
        UINT32_C(1) << STEP_OVERRIDE | UINT32_C(1) << STEP_TOOL_LENGTH |
        UINT32_C(1) << STEP_SYSTEM | UINT32_C(1) << STEP_PATH | UINT32_C(1) << STEP_RETRACT |
        UINT32_C(1) << STEP_MACHINE | UINT32_C(1) << STEP_REFERENCE |
        UINT32_C(1) << STEP_AXIS_OFFSET | UINT32_C(1) << STEP_AXIS_APPLIED;

    if (code->step == STEP_PLANE) {
        return (enum plane)code->argument != p->modes.plane;
    }
    if (code->step == STEP_MOTION) {
        return !is_compensable(code);
    }
    return (forbidden & (UINT32_C(1) << code->step)) != 0;
}

bool takt_cutter_allows(struct program *p, const struct program_code *code)
{
    if (!is_on(p) || !is_forbidden(p, code)) {
        return true;
    }
    return takt_report_error_code(p, TAKT_ERROR_CUTTER_ON, code->step, 0.0);
}

bool takt_cutter_allows_change(struct program *p, const struct program_code *code,
                               const struct program_modes *before)
{
    const struct program_modes *now = &p->modes;

    if (!is_on(p) || (point_is_same(&now->system_offset, &before->system_offset) &&
                      point_is_same(&now->axis_offset, &before->axis_offset) &&
                      point_is_same(&now->tool_offset, &before->tool_offset) &&
                      now->turn.degrees == before->turn.degrees)) {
        return true;
    }
    return takt_report_error_code(p, TAKT_ERROR_CUTTER_ON, code->step, 0.0);
}

static bool moves_in_plane(const struct program *p, const struct move *m)
{
    enum axis first;
    enum axis second;

    takt_plane_axes(m->plane, &first, &second);
    return move_is_arc(m) || m->end.at[first] != p->modes.at.at[first] ||
           m->end.at[second] != p->modes.at.at[second];
}

void takt_cutter_apply(struct program *p, struct move *m)
{
    p->modes.cutter_left = false;
    if (!is_on(p) || p->modes.cutter_radius_mm == 0.0) {
        return;
    }
    m->plane = p->modes.plane;
    m->cutter_side = p->modes.cutter_side;
    m->cutter_radius_mm = p->modes.cutter_radius_mm;
    m->cutter_orientation = p->modes.cutter_orientation;
    m->cutter_entry = !p->modes.cutter_moved;
    p->modes.cutter_moved = p->modes.cutter_moved || moves_in_plane(p, m);
}
