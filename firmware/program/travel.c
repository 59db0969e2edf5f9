#include "program/travel.h"

#include "base/maths.h"
#include "program/coordinates.h"
#include "program/report.h"
#include "program/words.h"

/* A coordinate may exceed a limit by this: rounding, below anything a machine resolves. */
#define TRAVEL_SLACK 1e-6

/* The axis's word, or the code that moves it when it has none. */
static bool outside(struct program *p, unsigned axis, double value)
{
    const char letter = (char)(AXIS_LETTERS[axis] - 'A' + 'a');
    const struct program_span span = words_has(p, letter) ? p->words.span[LETTER_INDEX(letter)]
                                     : words_has_step(p, STEP_MOTION)
                                         ? p->words.code_span[STEP_MOTION]
                                         : p->words.code_span[STEP_REFERENCE];

    diagnostic_set(&p->error, TAKT_ERROR_TRAVEL_EXCEEDED, p->lexer.line,
                   p->lexer.column[span.begin], &AXIS_LETTERS[axis], 1,
                   coordinates_to_parameter(value, (enum axis)axis));
    return false;
}

/* Written so that a coordinate that is no number fails. */
static bool check_axis(struct program *p, unsigned axis, double value)
{
    if ((p->config.axes & (1U << axis)) == 0) {
        return true;
    }
    if (value >= p->config.travel_min[axis] - TRAVEL_SLACK &&
        value <= p->config.travel_max[axis] + TRAVEL_SLACK) {
        return true;
    }
    return outside(p, axis, value);
}

/*
 * The extreme of an arc in one direction of its plane, a quarter turn: axis = centre + radius sign, where the
 * angle is quarter pi/2. The first time round and the last time round are looked at, because the radius may change
 * with the angle and is then largest in one of them.
 *
 *     turned = (quarter pi/2 - angle_start) mod 2 pi, in the sense of turning
 *     radius = radius_start + radius_change turned / |sweep|
 */
static bool check_quarter(struct program *p, const struct curve_arc *arc, unsigned quarter)
{
    const double sign = quarter < 2 ? 1.0 : -1.0;
    const unsigned in_plane = quarter % 2;
    const unsigned axis = in_plane == 0 ? arc->first : arc->second;
    const double sweep = maths_abs(arc->sweep_rad);
    double turned = quarter * MATHS_HALF_PI - arc->angle_start_rad;

    if (arc->sweep_rad < 0.0) {
        turned = -turned;
    }
    turned -= MATHS_TWO_PI * maths_floor(turned / MATHS_TWO_PI);
    if (turned > sweep) {
        return true;
    }
    const double last = turned + MATHS_TWO_PI * maths_floor((sweep - turned) / MATHS_TWO_PI);
    const double first_mm = arc->radius_start_mm + arc->radius_change_mm * turned / sweep;
    const double last_mm = arc->radius_start_mm + arc->radius_change_mm * last / sweep;

    return check_axis(p, axis, arc->centre_mm[in_plane] + sign * first_mm) &&
           check_axis(p, axis, arc->centre_mm[in_plane] + sign * last_mm);
}

static bool check_arc(struct program *p, const struct move *m)
{
    struct curve curve;

    if (!move_curve(m, &p->modes.at, &curve)) {
        return true;
    }
    for (unsigned quarter = 0; quarter < 4; quarter++) {
        if (!check_quarter(p, &curve.arc, quarter)) {
            return false;
        }
    }
    return true;
}

bool travel_check(struct program *p, const struct move *m)
{
    for (unsigned axis = 0; axis < AXIS_COUNT; axis++) {
        if (!check_axis(p, axis, m->end.at[axis])) {
            return false;
        }
    }
    return m->kind == MOVE_RAPID || m->kind == MOVE_FEED || check_arc(p, m);
}
