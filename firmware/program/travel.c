#include "program/travel.h"

#include "base/maths.h"
#include "geometry/involute.h"
#include "geometry/quintic.h"
#include "program/coordinates.h"
#include "program/lexer.h"
#include "program/report.h"
#include "program/words.h"

/* A coordinate may exceed a limit by this: rounding, below anything a machine resolves. */
#define TRAVEL_SLACK 1e-6

/* Looks for a coordinate outside. */
struct travel {
    const struct program_config *config;
    struct travel_excess *excess;
};

/* Written so that a coordinate that is no number fails. */
static bool check_axis(const struct travel *t, unsigned axis, double value)
{
    const double low = t->config->travel_min[axis];
    const double high = t->config->travel_max[axis];

    if ((t->config->axes & (1U << axis)) == 0 ||
        (value >= low - TRAVEL_SLACK && value <= high + TRAVEL_SLACK)) {
        return true;
    }
    *t->excess = (struct travel_excess){(enum axis)axis, value, value < low ? low : high};
    return false;
}

/*
 * The extreme of an arc in one direction of its plane, a quarter turn: axis = centre + radius sign,
 * where the angle is quarter pi/2. The first time round and the last time round are looked at,
 * because the radius may change with the angle and is then largest in one of them.
 *
 *     turned = (quarter pi/2 - angle_start) mod 2 pi, in the sense of turning
 *     radius = radius_start + radius_change turned / |sweep|
 */
static bool check_quarter(const struct travel *t, const struct curve_arc *arc, unsigned quarter)
{
    const double sign = quarter < 2 ? 1.0 : -1.0;
    const unsigned in_plane = quarter % 2;
    const unsigned axis = in_plane == 0 ? arc->first : arc->second;
    const double sweep = maths_abs(arc->sweep_rad);
    double turned = quarter * MATHS_HALF_PI - arc->angle_start_rad;

    if (arc->sweep_rad < 0.0) {
        turned = -turned;
    }
    turned -= MATHS_TWO_PI * takt_maths_floor(turned / MATHS_TWO_PI);
    if (turned > sweep) {
        return true;
    }
    const double last = turned + MATHS_TWO_PI * takt_maths_floor((sweep - turned) / MATHS_TWO_PI);
    const double first_mm = arc->radius_start_mm + arc->radius_change_mm * turned / sweep;
    const double last_mm = arc->radius_start_mm + arc->radius_change_mm * last / sweep;

    return check_axis(t, axis, arc->centre_mm[in_plane] + sign * first_mm) &&
           check_axis(t, axis, arc->centre_mm[in_plane] + sign * last_mm);
}

/* The outermost point of an involute in that direction: it lies where the curve runs across it. */
static bool check_involute_quarter(const struct travel *t, const struct curve *c, unsigned quarter)
{
    const unsigned axis = quarter % 2 == 0 ? c->involute.second : c->involute.first;
    struct point p;
    double s_mm;

    if (!takt_involute_extreme(c, quarter, &s_mm)) {
        return true;
    }
    takt_curve_point(c, s_mm, &p);
    return check_axis(t, axis, p.at[axis]);
}

/* The outermost points of a piece of a spline. */
static bool check_quintic(const struct travel *t, const struct curve *c)
{
    for (unsigned i = 0; i < 2; i++) {
        const unsigned axis = i == 0 ? c->quintic.first : c->quintic.second;
        struct point p;
        double s_mm;

        if (takt_quintic_extreme(c, i, &s_mm)) {
            takt_curve_point(c, s_mm, &p);
            if (!check_axis(t, axis, p.at[axis])) {
                return false;
            }
        }
    }
    return true;
}

static bool check_curved(const struct travel *t, const struct point *start, const struct move *m)
{
    struct curve c;

    if (!takt_move_curve(m, start, &c)) {
        return true;
    }
    if (c.kind == CURVE_QUINTIC) {
        return check_quintic(t, &c);
    }
    for (unsigned quarter = 0; quarter < 4; quarter++) {
        const bool holds = c.kind == CURVE_ARC ? check_quarter(t, &c.arc, quarter)
                                               : check_involute_quarter(t, &c, quarter);

        if (!holds) {
            return false;
        }
    }
    return true;
}

bool takt_travel_holds(const struct program_config *config, const struct point *start,
                       const struct move *m, struct travel_excess *excess)
{
    const struct travel t = {config, excess};

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (!check_axis(&t, i, m->end.at[i])) {
            return false;
        }
    }
    return !move_is_curved(m) || check_curved(&t, start, m);
}

void takt_travel_report(struct diagnostic *d, uint32_t line, uint32_t column,
                        const struct travel_excess *excess)
{
    takt_diagnostic_set(d, TAKT_ERROR_TRAVEL_EXCEEDED, line, column, &AXIS_LETTERS[excess->axis], 1,
                        takt_coordinates_to_parameter(excess->value, excess->axis));
    takt_diagnostic_set_limit(d, takt_coordinates_to_parameter(excess->limit, excess->axis));
}

/* The axis's word, or the code that moves it when it has none. */
static struct program_span span_of(const struct program *p, enum axis axis)
{
    const char letter = (char)(AXIS_LETTERS[axis] - 'A' + 'a');

    if (words_has(p, letter)) {
        return p->words.span[LETTER_INDEX(letter)];
    }
    return p->words.code_span[words_has_step(p, STEP_MOTION) ? STEP_MOTION : STEP_REFERENCE];
}

bool takt_travel_check(struct program *p, const struct move *m)
{
    struct travel_excess excess;

    if (m->cutter_side != CUTTER_OFF || takt_travel_holds(&p->config, &p->modes.at, m, &excess)) {
        return true;
    }
    takt_travel_report(&p->error, p->lexer.line,
                       takt_lexer_column(&p->lexer, span_of(p, excess.axis).begin), &excess);
    return false;
}
