/*
 * Two ways to tell where an arc's centre is.
 *
 * I J K: the offset of the centre from the start (G91.1) or its coordinates (G90.1). The end need
 * not be exactly on the circle of the start; how far it may be off is what LinuxCNC allows.
 *
 * R: the radius; of the two arcs shorter than half a turn the one that turns the right way, or with
 * a negative R the one longer than half a turn. With the chord from start to end of length 2 h and
 * its middle M, the centre is
 *
 *     M + sqrt(R^2 - h^2) n,   n the unit normal of the chord: to its left for G3 and R > 0 or G2 and R < 0
 */
#include "program/circular.h"

#include "base/assert.h"
#include "base/maths.h"
#include "program/coordinates.h"
#include "program/emit.h"
#include "program/lexer.h"
#include "program/report.h"
#include "program/words.h"

/*
 * Difference of the radii at start and end that is always allowed, by the program's units: an end
 * and a centre rounded to 0.01 mm or 0.001 inch.
 */
#define OFF_CIRCLE_MAX_MM   (2.0 * 0.01 * 1.41421356237309504880)
#define OFF_CIRCLE_MAX_INCH (2.0 * 0.001 * 1.41421356237309504880)
/* A larger one is allowed up to this share of the larger radius ... */
#define OFF_CIRCLE_MAX_RATIO 1e-3
/* ... and up to this many times the one above. */
#define OFF_CIRCLE_TIMES 100.0

/* Radii below this are none, and an R may be this much too short. 0.00005 inch. */
#define RADIUS_SLACK_MM 0.00127
/* From this ratio of h to R on the arc is half a turn. */
#define HALF_TURN_RATIO (1.0 - 1e-12)

/* What an arc looks like in its plane. */
struct circle {
    enum axis first, second;
    double start_mm[2], end_mm[2], centre_mm[2];
};

static char centre_letter(enum axis axis)
{
    TAKT_ASSERT(axis < AXIS_LINEAR_COUNT);
    return (char)('i' + (int)axis);
}

static double distance(const double a[2], const double b[2])
{
    const double x = a[0] - b[0];
    const double y = a[1] - b[1];

    return maths_sqrt(x * x + y * y);
}

/* About a letter that is not on the line, at the arc's code. */
static bool missing(struct program *p, enum takt_error code, const char *letter)
{
    const unsigned begin = p->words.code_span[STEP_MOTION].begin;

    takt_diagnostic_set(&p->error, code, p->lexer.line, takt_lexer_column(&p->lexer, begin), letter,
                        1, 0.0);
    return false;
}

/* The word of one coordinate of the centre, mm. */
static bool centre_word(struct program *p, enum axis axis, double *word_mm)
{
    const char letter = centre_letter(axis);
    const char name = (char)(letter - 'a' + 'A');

    *word_mm = words_has(p, letter) ? words_value(p, letter) * p->modes.unit_mm : 0.0;
    if (p->modes.centre_absolute && !words_has(p, letter)) {
        return missing(p, TAKT_ERROR_ARC_CENTRE_PARTIAL, &name);
    }
    return true;
}

bool takt_circular_centre(struct program *p, enum axis first, enum axis second, double centre_mm[2])
{
    const struct program_modes *m = &p->modes;
    const enum axis axis[2] = {first, second};
    double word_mm[2];

    if (!centre_word(p, first, &word_mm[0]) || !centre_word(p, second, &word_mm[1])) {
        return false;
    }
    for (unsigned i = 0; m->centre_absolute && i < 2; i++) {
        word_mm[i] += m->axis_offset.at[axis[i]];
    }
    if (m->plane == PLANE_XY) {
        takt_coordinates_turn(&m->turn, &word_mm[0], &word_mm[1]);
    }
    for (unsigned i = 0; i < 2; i++) {
        centre_mm[i] = word_mm[i] + (m->centre_absolute
                                         ? m->system_offset.at[axis[i]] + m->tool_offset.at[axis[i]]
                                         : m->at.at[axis[i]]);
    }
    return true;
}

double takt_circular_slack_mm(const struct program *p)
{
    return p->modes.unit_mm == 1.0 ? OFF_CIRCLE_MAX_MM : OFF_CIRCLE_MAX_INCH * p->modes.unit_mm;
}

static bool check_radii(struct program *p, const struct circle *c)
{
    const double start_mm = distance(c->start_mm, c->centre_mm);
    const double end_mm = distance(c->end_mm, c->centre_mm);
    const double off_mm = maths_abs(start_mm - end_mm);
    const double always_mm = takt_circular_slack_mm(p);
    const double ratio_mm = OFF_CIRCLE_MAX_RATIO * maths_max(start_mm, end_mm);

    if (start_mm < RADIUS_SLACK_MM || end_mm < RADIUS_SLACK_MM) {
        return takt_report_error_code(p, TAKT_ERROR_ARC_RADIUS_ZERO, STEP_MOTION, 0.0);
    }
    if (off_mm <= always_mm || (off_mm <= ratio_mm && off_mm <= OFF_CIRCLE_TIMES * always_mm)) {
        return true;
    }
    return takt_report_error_code(p, TAKT_ERROR_ARC_ENDPOINT, STEP_MOTION, off_mm);
}

static bool centre_from_offsets(struct program *p, struct circle *c)
{
    return takt_circular_centre(p, c->first, c->second, c->centre_mm) && check_radii(p, c);
}

/* sqrt(R^2 - h^2), 0 when R is as good as h. */
static double centre_distance(double radius_mm, double half_mm)
{
    TAKT_ASSERT(radius_mm >= 0.0 && half_mm >= 0.0);
    if (half_mm >= radius_mm * HALF_TURN_RATIO) {
        return 0.0;
    }
    return maths_sqrt((radius_mm - half_mm) * (radius_mm + half_mm));
}

static bool centre_from_radius(struct program *p, struct circle *c, bool clockwise)
{
    const double given_mm = words_value(p, 'r') * p->modes.unit_mm;
    const double radius_mm = maths_abs(given_mm);
    const double x = c->end_mm[0] - c->start_mm[0];
    const double y = c->end_mm[1] - c->start_mm[1];
    const double half_mm = distance(c->start_mm, c->end_mm) * 0.5;

    if (half_mm == 0.0) {
        return takt_report_error_letter(p, TAKT_ERROR_ARC_CLOSED, 'r', 0.0);
    }
    if (half_mm - radius_mm > RADIUS_SLACK_MM) {
        return takt_report_error_letter(p, TAKT_ERROR_ARC_RADIUS_SMALL, 'r', half_mm - radius_mm);
    }
    const bool left = clockwise != (given_mm > 0.0);
    const double along =
        centre_distance(radius_mm, half_mm) / (2.0 * half_mm) * (left ? 1.0 : -1.0);

    c->centre_mm[0] = (c->start_mm[0] + c->end_mm[0]) * 0.5 - along * y;
    c->centre_mm[1] = (c->start_mm[1] + c->end_mm[1]) * 0.5 + along * x;
    return true;
}

bool takt_circular_check_axes(struct program *p, enum axis first, enum axis second)
{
    const unsigned takt_plane_axes = (1U << first) | (1U << second);

    TAKT_ASSERT(first != second && first < AXIS_LINEAR_COUNT && second < AXIS_LINEAR_COUNT);
    if ((p->config.axes & takt_plane_axes) != takt_plane_axes) {
        const bool first_missing = (p->config.axes & (1U << first)) == 0;

        return missing(p, TAKT_ERROR_AXIS_MISSING, &AXIS_LETTERS[first_missing ? first : second]);
    }
    if (p->modes.turn.degrees != 0.0 && p->modes.plane != PLANE_XY) {
        return takt_report_error_code(p, TAKT_ERROR_ARC_TILTED, STEP_MOTION, p->modes.turn.degrees);
    }
    if (p->modes.cutter_left) {
        return takt_report_error_code(p, TAKT_ERROR_CUTTER_EXIT_ARC, STEP_MOTION, 0.0);
    }
    return true;
}

/* The centre's word of the axis across the plane has no meaning. */
bool takt_circular_check_plane(struct program *p, enum axis first, enum axis second)
{
    const enum axis other = (enum axis)(AXIS_X + AXIS_Y + AXIS_Z - first - second);

    TAKT_ASSERT(first != second && first < AXIS_LINEAR_COUNT && second < AXIS_LINEAR_COUNT);
    if (!takt_circular_check_axes(p, first, second)) {
        return false;
    }
    if (words_has(p, centre_letter(other))) {
        return takt_report_error_letter(p, TAKT_ERROR_WORD_UNUSED, centre_letter(other), 0.0);
    }
    return true;
}

static bool check_words(struct program *p, const struct circle *c)
{
    const bool offsets = (p->words.given & LETTERS_CENTRE) != 0;

    if (!takt_circular_check_plane(p, c->first, c->second)) {
        return false;
    }
    if (words_has(p, 'r') && offsets) {
        return takt_report_error_letter(p, TAKT_ERROR_ARC_CENTRE_TWICE, 'r', 0.0);
    }
    if (!words_has(p, 'r') && !offsets) {
        return takt_report_error_code(p, TAKT_ERROR_ARC_CENTRE_MISSING, STEP_MOTION, 0.0);
    }
    return true;
}

static void set_circle(const struct program *p, const struct point *end, struct circle *c)
{
    takt_plane_axes(p->modes.plane, &c->first, &c->second);
    c->start_mm[0] = p->modes.at.at[c->first];
    c->start_mm[1] = p->modes.at.at[c->second];
    c->end_mm[0] = end->at[c->first];
    c->end_mm[1] = end->at[c->second];
}

bool takt_circular_find_centre(struct program *p, const struct program_code *code,
                               const struct point *end, double centre_mm[2])
{
    const bool clockwise = code->argument == MOVE_ARC_CW;
    struct circle c;

    set_circle(p, end, &c);
    if (!check_words(p, &c) ||
        !(words_has(p, 'r') ? centre_from_radius(p, &c, clockwise) : centre_from_offsets(p, &c))) {
        return false;
    }
    centre_mm[0] = c.centre_mm[0];
    centre_mm[1] = c.centre_mm[1];
    return true;
}

bool takt_circular_move(struct program *p, const struct program_code *code)
{
    struct point end;
    struct move m;

    takt_coordinates_end(p, &end);
    takt_emit_prepare(p, (enum move_kind)code->argument, &end, &m);
    if (!takt_circular_find_centre(p, code, &end, m.centre_mm)) {
        return false;
    }
    m.plane = p->modes.plane;
    m.turns = 1;
    if (words_has(p, 'p') && !takt_words_whole(p, 'p', 1.0, PROGRAM_TURNS_MAX, &m.turns)) {
        return false;
    }
    p->modes.motion = code;
    return takt_emit_motion(p, &m);
}
