#include "program/spline.h"

#include "base/assert.h"
#include "base/maths.h"
#include "program/circular.h"
#include "program/coordinates.h"
#include "program/emit.h"
#include "program/report.h"
#include "program/travel.h"
#include "program/words.h"

#include <string.h>

/* Order without L or P. */
#define ORDER_DEFAULT 3U

/*
 * The first control point of G6.2 is where the tool is: off by no more than rounded coordinates
 * are.
 */
#define START_MM 0.01

/*
 * So much of G64 P may take pieces off the curve: they are three times as long as those of the
 * exact path, and as many of them as are smoothed at a time reach as much farther. A thousandth
 * makes 500 random programs 0.1 % quicker: a piece's evenness decides then (geometry/nurbs.c).
 */
#define ERROR_OF_TOLERANCE 1e-4

bool takt_spline_allows(struct program *p, const struct program_code *code)
{
    return !p->cycle.spline_open || code->run == takt_spline_start || code->step == STEP_FEED ||
           takt_report_error_code(p, TAKT_ERROR_SPLINE_OPEN, code->step, 0.0);
}

bool takt_spline_ends(struct program *p)
{
    static const char end[] = "the end";

    if (p->cycle.spline_open) {
        takt_diagnostic_set(&p->error, TAKT_ERROR_SPLINE_OPEN, p->lexer.line, 0, end,
                            sizeof(end) - 1, 0.0);
    }
    return !p->cycle.spline_open;
}

/* -- control points and knots -- */

/* A vector of two words, mm, turned as the coordinate system is. */
static void vector(const struct program *p, char first, char second, double v[2])
{
    v[0] = words_has(p, first) ? words_value(p, first) * p->modes.unit_mm : 0.0;
    v[1] = words_has(p, second) ? words_value(p, second) * p->modes.unit_mm : 0.0;
    takt_coordinates_turn(&p->modes.turn, &v[0], &v[1]);
}

/* Machine coordinates of the axis words. With G91 they count from the start of the curve. */
static void point_of_words(struct program *p, double at_mm[2])
{
    const enum axis *axis = p->cycle.axis;
    const struct point at = p->modes.at;
    struct point end;

    for (unsigned i = 0; i < 2; i++) {
        p->modes.at.at[axis[i]] = p->cycle.spline.from_mm[i];
    }
    takt_coordinates_end(p, &end);
    p->modes.at = at;
    for (unsigned i = 0; i < 2; i++) {
        at_mm[i] = end.at[axis[i]];
    }
}

/*
 * The next control point of a curve with even knots, open at its ends: 0 as often as the order,
 * then 1, 2, ...
 */
static void add_even(struct program_spline *s, const double at_mm[2], double weight)
{
    const uint32_t order = s->nurbs.order;

    TAKT_ASSERT(weight > 0.0);
    takt_nurbs_add_point(&s->nurbs, at_mm, weight);
    takt_nurbs_add_knot(&s->nurbs,
                        s->nurbs.points <= order ? 0.0 : (double)(s->nurbs.points - order));
}

static void close_even(struct program_spline *s)
{
    TAKT_ASSERT(s->nurbs.points >= s->nurbs.order);
    s->closing = s->nurbs.order;
    s->knot_end = (double)(s->nurbs.points - s->nurbs.order + 1);
}

static void begin(struct program *p, uint32_t order)
{
    struct program_spline *s = &p->cycle.spline;

    takt_nurbs_open(&s->nurbs, order);
    s->closing = 0;
    for (unsigned i = 0; i < 2; i++) {
        s->from_mm[i] = p->modes.at.at[p->cycle.axis[i]];
    }
}

/* -- the codes -- */

/*
 * A point between start and end: from the start by I J, or as the curve before ended; P Q from the
 * end.
 */
static bool add_cubic(struct program *p, const struct program_code *code)
{
    struct program_spline *s = &p->cycle.spline;
    double lead[2] = {-s->tail_mm[0], -s->tail_mm[1]};
    double end[2];

    if (words_has(p, 'i') != words_has(p, 'j')) {
        return takt_report_missing(p, code->step, words_has(p, 'i') ? 'j' : 'i');
    }
    if (!words_has(p, 'i') && p->modes.motion != code) {
        return takt_report_missing(p, code->step, 'i');
    }
    if (!words_has(p, 'p') || !words_has(p, 'q')) {
        return takt_report_missing(p, code->step, words_has(p, 'p') ? 'q' : 'p');
    }
    if (words_has(p, 'i')) {
        vector(p, 'i', 'j', lead);
    }
    vector(p, 'p', 'q', s->tail_mm);
    begin(p, 4);
    point_of_words(p, end);
    add_even(s, s->from_mm, 1.0);
    add_even(s, (double[2]){s->from_mm[0] + lead[0], s->from_mm[1] + lead[1]}, 1.0);
    add_even(s, (double[2]){end[0] + s->tail_mm[0], end[1] + s->tail_mm[1]}, 1.0);
    add_even(s, end, 1.0);
    close_even(s);
    return true;
}

static bool add_quadratic(struct program *p, const struct program_code *code)
{
    struct program_spline *s = &p->cycle.spline;
    double lead[2];
    double end[2];

    vector(p, 'i', 'j', lead);
    if (lead[0] == 0.0 && lead[1] == 0.0) {
        return takt_report_missing(p, code->step, words_has(p, 'i') ? 'j' : 'i');
    }
    begin(p, 3);
    point_of_words(p, end);
    add_even(s, s->from_mm, 1.0);
    add_even(s, (double[2]){s->from_mm[0] + lead[0], s->from_mm[1] + lead[1]}, 1.0);
    add_even(s, end, 1.0);
    close_even(s);
    return true;
}

/* A weight, 1 without its word. */
static bool take_weight(struct program *p, char letter, double *weight)
{
    *weight = words_has(p, letter) ? words_value(p, letter) : 1.0;
    return *weight > 0.0 ||
           takt_report_error_letter(p, TAKT_ERROR_WORD_NOT_POSITIVE, letter, *weight);
}

static bool take_order(struct program *p, char letter, uint32_t *order)
{
    *order = ORDER_DEFAULT;
    return !words_has(p, letter) ||
           takt_words_whole(p, letter, NURBS_ORDER_MIN, NURBS_ORDER_MAX, order);
}

static bool has_both(struct program *p, const struct program_code *code)
{
    for (unsigned i = 0; i < 2; i++) {
        const char letter = takt_coordinates_letter(p->cycle.axis[i]);

        if (!words_has(p, letter)) {
            return takt_report_missing(p, code->step, letter);
        }
    }
    return true;
}

/* The tool is at the first control point, whose weight is 1 unless P stands alone. */
static bool add_points(struct program *p, const struct program_code *code)
{
    struct program_spline *s = &p->cycle.spline;
    const bool alone = (p->words.given & LETTERS_LINEAR) == 0;
    uint32_t order;
    double weight;
    double at[2];

    if (!take_weight(p, 'p', &weight) || !take_order(p, 'l', &order)) {
        return false;
    }
    if (!p->cycle.spline_open) {
        begin(p, order < ORDER_DEFAULT ? ORDER_DEFAULT : order);
        add_even(s, s->from_mm, alone ? weight : 1.0);
    } else if (words_has(p, 'l') && order != s->nurbs.order) {
        return takt_report_error_letter(p, TAKT_ERROR_WORD_OUT_OF_RANGE, 'l', order);
    }
    p->cycle.spline_open = true;
    if (alone) {
        return true;
    }
    if (!has_both(p, code)) {
        return false;
    }
    point_of_words(p, at);
    add_even(s, at, weight);
    return true;
}

static bool end_points(struct program *p, const struct program_code *code)
{
    struct program_spline *s = &p->cycle.spline;

    if (!p->cycle.spline_open) {
        return takt_report_error_code(p, TAKT_ERROR_SPLINE_ABSENT, code->step, 0.0);
    }
    if (s->nurbs.points < s->nurbs.order) {
        return takt_report_error_code(p, TAKT_ERROR_SPLINE_SHORT, code->step, s->nurbs.order);
    }
    close_even(s);
    p->cycle.spline_open = false;
    return true;
}

/* The first control point is where the tool is. */
static bool begin_knots(struct program *p)
{
    struct program_spline *s = &p->cycle.spline;
    uint32_t order;
    double at[2];

    if (!take_order(p, 'p', &order)) {
        return false;
    }
    begin(p, order);
    point_of_words(p, at);
    const double off[2] = {at[0] - s->from_mm[0], at[1] - s->from_mm[1]};
    const double off_mm = maths_sqrt(off[0] * off[0] + off[1] * off[1]);

    return off_mm <= START_MM ||
           takt_report_error_code(p, TAKT_ERROR_SPLINE_START, STEP_MOTION, off_mm);
}

/*
 * Knots rise; between the ends none is as often there as the order, where the curve would be torn.
 */
static bool check_knot(struct program *p, double knot)
{
    const struct nurbs *n = &p->cycle.spline.nurbs;
    const bool ends = n->knots < n->order || n->points < n->knots;
    const uint32_t back = ends ? 1 : n->order - 1;

    if (n->knots >= back && n->knots > 0) {
        const double before = n->knot[(n->knots - back) % NURBS_KEPT];

        if (ends ? knot < before : knot <= before) {
            return takt_report_error_letter(p, TAKT_ERROR_SPLINE_KNOT, 'k', knot);
        }
    }
    return maths_is_finite(knot);
}

/*
 * A control point and its knot; knots alone, of which there are as many more as the order, end the
 * curve.
 */
static bool add_knots(struct program *p, const struct program_code *code)
{
    struct program_spline *s = &p->cycle.spline;
    const bool alone = (p->words.given & LETTERS_LINEAR) == 0;
    double weight;
    double at[2];

    if (!words_has(p, 'k')) {
        return takt_report_missing(p, code->step, 'k');
    }
    if (!take_weight(p, 'r', &weight) || (!alone && !has_both(p, code))) {
        return false;
    }
    if (!p->cycle.spline_open && (alone || !begin_knots(p))) {
        return !alone ? false
                      : takt_report_error_code(p, TAKT_ERROR_SPLINE_ABSENT, code->step, 0.0);
    }
    if (!alone && s->nurbs.points < s->nurbs.knots) {
        return takt_report_missing(p, code->step, 'k');
    }
    if (alone && s->nurbs.points < s->nurbs.order) {
        return takt_report_error_code(p, TAKT_ERROR_SPLINE_SHORT, code->step, s->nurbs.order);
    }
    if (!check_knot(p, words_value(p, 'k'))) {
        return false;
    }
    if (!alone) {
        point_of_words(p, at);
        takt_nurbs_add_point(&s->nurbs, s->nurbs.points == 0 ? s->from_mm : at, weight);
    }
    takt_nurbs_add_knot(&s->nurbs, words_value(p, 'k'));
    p->cycle.spline_open = s->nurbs.knots < s->nurbs.points + s->nurbs.order;
    return true;
}

static bool add_line(struct program *p, const struct program_code *code)
{
    switch ((enum spline)code->argument) {
    case SPLINE_CUBIC:
        return add_cubic(p, code);
    case SPLINE_QUADRATIC:
        return add_quadratic(p, code);
    case SPLINE_POINTS:
        return add_points(p, code);
    case SPLINE_END:
        return end_points(p, code);
    case SPLINE_KNOTS:
        break;
    }
    return add_knots(p, code);
}

/* -- pieces -- */

static double error_mm(const struct program *p)
{
    const double tolerance_mm = p->modes.path == PATH_BLEND ? p->modes.tolerance_mm : 0.0;

    return maths_max(NURBS_ERROR_MM, ERROR_OF_TOLERANCE * tolerance_mm);
}

static enum nurbs_result next_piece(struct program *p, struct nurbs_piece *piece)
{
    struct program_spline *s = &p->cycle.spline;
    enum nurbs_result result = takt_nurbs_next(&s->nurbs, error_mm(p), piece);

    while (result == NURBS_NONE && s->closing > 0) {
        takt_nurbs_add_knot(&s->nurbs, s->knot_end);
        s->closing--;
        result = takt_nurbs_next(&s->nurbs, error_mm(p), piece);
    }
    return result;
}

static void set_move(const struct program *p, const struct nurbs_piece *piece, struct move *move)
{
    *move = p->cycle.feed;
    move->end = p->modes.at;
    for (unsigned i = 0; i < 2; i++) {
        move->end.at[p->cycle.axis[i]] = piece->end_mm[i];
        move->heading_rad[i] = piece->course.heading_rad[i];
        move->curvature_1_mm[i] = piece->course.curvature_1_mm[i];
    }
    move->spline_mm = piece->course.length_mm;
}

/* Goes along all pieces that the line decides, and comes back. */
static bool check_pieces(struct program *p)
{
    const struct point at = p->modes.at;
    const struct program_spline before = p->cycle.spline;
    enum nurbs_result result;
    struct nurbs_piece piece;
    bool good = true;

    while (good && (result = next_piece(p, &piece)) != NURBS_NONE) {
        struct move m;

        if (result == NURBS_CUSP) {
            good = takt_report_error_code(p, TAKT_ERROR_SPLINE_CUSP, STEP_MOTION, 0.0);
            break;
        }
        set_move(p, &piece, &m);
        good = takt_travel_check(p, &m);
        p->modes.at = m.end;
    }
    p->modes.at = at;
    p->cycle.spline = before;
    return good;
}

bool takt_spline_next(struct program *p, struct move *move)
{
    struct nurbs_piece piece;

    if (next_piece(p, &piece) != NURBS_PIECE) {
        p->cycle.code = NULL;
        return false;
    }
    set_move(p, &piece, move);
    p->modes.at = move->end;
    return true;
}

static bool check_use(struct program *p, const struct program_code *code)
{
    const char across = takt_coordinates_letter(p->cycle.axis[2]);
    const bool offset_words = code->argument == SPLINE_CUBIC || code->argument == SPLINE_QUADRATIC;

    if (p->modes.inverse_time) {
        return takt_report_error_code(p, TAKT_ERROR_FEED_MODE_UNFIT, code->step, 0.0);
    }
    if (p->modes.cutter_side != CUTTER_OFF) {
        return takt_report_error_code(p, TAKT_ERROR_CUTTER_ON, code->step, 0.0);
    }
    if (offset_words && p->modes.plane != PLANE_XY) {
        return takt_report_error_code(p, TAKT_ERROR_SPLINE_PLANE, code->step, 0.0);
    }
    if (words_has(p, across)) {
        return takt_report_error_letter(p, TAKT_ERROR_WORD_UNUSED, across, 0.0);
    }
    return takt_circular_check_axes(p, p->cycle.axis[0], p->cycle.axis[1]);
}

bool takt_spline_start(struct program *p, const struct program_code *code)
{
    struct program_cycle *c = &p->cycle;

    takt_plane_axes(p->modes.plane, &c->axis[0], &c->axis[1]);
    c->axis[2] = (enum axis)(AXIS_X + AXIS_Y + AXIS_Z - c->axis[0] - c->axis[1]);
    takt_emit_prepare(p, MOVE_SPLINE, &p->modes.at, &c->feed);
    c->feed.plane = p->modes.plane;
    if (!check_use(p, code) || !takt_emit_set_feed(p, &c->feed) || !add_line(p, code) ||
        !check_pieces(p)) {
        return false;
    }
    c->code = code;
    c->before = p->queue_count;
    p->modes.motion = code->argument == SPLINE_END ? NULL : code;
    return true;
}
