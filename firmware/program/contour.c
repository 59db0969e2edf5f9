#include "program/contour.h"

#include "base/assert.h"
#include "base/maths.h"
#include "program/calls.h"
#include "program/circular.h"
#include "program/coordinates.h"
#include "program/cutter.h"
#include "program/emit.h"
#include "program/lexer.h"
#include "program/report.h"
#include "program/straight.h"
#include "program/travel.h"
#include "program/words.h"

/* Moves of a cycle: what goes beyond is a mistake. */
#define MOVES_MAX (100 * PROGRAM_REPEATS_MAX)

/* -- the code -- */

static struct profile_point point_of(const struct program *p, const struct point *machine)
{
    struct point work;

    takt_coordinates_work_of(p, machine, &work);
    return (struct profile_point){work.at[AXIS_Z], work.at[AXIS_X]};
}

static bool check_use(struct program *p, const struct program_code *code)
{
    if (p->modes.plane != PLANE_ZX || p->modes.turn.degrees != 0.0) {
        return takt_report_error_code(p, TAKT_ERROR_PROFILE_PLANE, code->step, 0.0);
    }
    if (p->modes.inverse_time) {
        return takt_report_error_code(p, TAKT_ERROR_FEED_MODE_UNFIT, code->step, 0.0);
    }
    return takt_circular_check_axes(p, AXIS_Z, AXIS_X);
}

static double length_or(const struct program *p, char letter, double otherwise)
{
    return words_has(p, letter) ? words_value(p, letter) * p->modes.unit_mm : otherwise;
}

/* Without words: D 0, E 0, P 1, I 1 and R 0.5 in the program's units. */
static bool set_words(struct program *p, const struct program_code *code, struct turning_words *t)
{
    t->kind = (uint8_t)(code->argument & ~CONTOUR_FACING);
    t->facing = (code->argument & CONTOUR_FACING) != 0;
    t->distance_mm = length_or(p, 'd', 0.0);
    t->last_mm = length_or(p, 'e', 0.0);
    t->step_mm = length_or(p, 'i', p->modes.unit_mm);
    t->retract_mm = length_or(p, 'r', 0.5 * p->modes.unit_mm);
    t->passes = 1;
    if (!(t->step_mm > 2.0 * PROFILE_SAME_MM)) {
        return takt_report_error_letter(p, TAKT_ERROR_WORD_NOT_POSITIVE, 'i', words_value(p, 'i'));
    }
    if (t->retract_mm < 0.0) {
        return takt_report_error_letter(p, TAKT_ERROR_WORD_NEGATIVE, 'r', words_value(p, 'r'));
    }
    return !words_has(p, 'p') || takt_words_whole(p, 'p', 1.0, PROGRAM_REPEATS_MAX, &t->passes);
}

/* The cycle begins where X and Z say. */
static bool go_to_start(struct program *p)
{
    const enum cutter_side side = p->modes.cutter_side;
    struct point end;
    struct move m;

    if ((p->words.given & (LETTER_BIT('x') | LETTER_BIT('z'))) == 0) {
        return true;
    }
    takt_coordinates_end(p, &end);
    p->modes.cutter_side = CUTTER_OFF;
    takt_emit_prepare(p, MOVE_RAPID, &end, &m);
    const bool good = takt_emit_motion(p, &m);

    p->modes.cutter_side = side;
    return good;
}

static void begin_profile(struct program *p, const struct program_code *code)
{
    struct program_contour *c = &p->cycle.contour;

    c->code = code;
    c->start = p->modes.at;
    c->at = point_of(p, &c->start);
    c->line = p->lexer.line;
    c->column = (uint16_t)takt_lexer_column(&p->lexer, p->words.code_span[code->step].begin);
    c->calls = p->flow.calls;
    c->begun = false;
    c->failed = false;
}

bool takt_contour_start(struct program *p, const struct program_code *code)
{
    struct program_cycle *c = &p->cycle;
    uint32_t label = 0;

    if (!check_use(p, code)) {
        return false;
    }
    if (!words_has(p, 'q')) {
        return takt_report_missing(p, code->step, 'q');
    }
    if (!takt_words_whole(p, 'q', 0.0, PROGRAM_LABEL_MAX, &label) ||
        !set_words(p, code, &c->contour.words) || !go_to_start(p)) {
        return false;
    }
    takt_emit_prepare(p, MOVE_FEED, &p->modes.at, &c->feed);
    if (!takt_emit_set_feed(p, &c->feed)) {
        return false;
    }
    begin_profile(p, code);
    if (!takt_calls_call_number(p, code, label)) {
        return false;
    }
    p->modes.motion = takt_code_find('g', 0);
    c->contour_open = true;
    return true;
}

/* -- the profile -- */

/* About the cycle, when its line is not the current one any more. */
static bool report(struct program *p, enum takt_error error, double value)
{
    const struct program_contour *c = &p->cycle.contour;
    const unsigned number = c->code->number_x10;
    const char digit = (char)('0' + number % 10);
    const char name[] = {'G', (char)('0' + number / 100), (char)('0' + number / 10 % 10), '.',
                         digit};

    TAKT_ASSERT(error != TAKT_OK);
    takt_diagnostic_set(&p->error, error, c->line, c->column, name, number % 10 == 0 ? 3 : 5,
                        value);
    return false;
}

/*
 * NULL: no room, p->error is set. The queue has been fetched before the profile's first line is
 * read: it lies in its place.
 */
static struct profile_segment *add_segment(struct program *p)
{
    struct profile *profile = &p->turning.profile;

    TAKT_ASSERT(p->queue_count == 0);
    if (!p->cycle.contour.begun) {
        p->cycle.contour.begun = true;
        profile->count = 0;
    }
    if (profile->count == PROGRAM_CONTOUR_MAX) {
        (void)report(p, TAKT_ERROR_PROFILE_LONG, PROGRAM_CONTOUR_MAX);
        return NULL;
    }
    struct profile_segment *s = &profile->segment[profile->count++];

    *s = (struct profile_segment){.kind = PROFILE_LINE};
    return s;
}

/* X and Z, or U and W from where the profile has come to. */
static void end_of_line(const struct program *p, struct point *end)
{
    const double diameter = p->modes.diameter ? 0.5 : 1.0;

    takt_coordinates_end(p, end);
    end->at[AXIS_X] += length_or(p, 'u', 0.0) * diameter;
    end->at[AXIS_Z] += length_or(p, 'w', 0.0);
}

/* A: a fillet, C: a chamfer, at the end of the line. */
static bool add_corner(struct program *p, char letter, enum profile_kind kind)
{
    if (!words_has(p, letter)) {
        return true;
    }
    struct profile_segment *s = add_segment(p);
    const struct profile_point at = p->cycle.contour.at;

    if (s != NULL) {
        *s = (struct profile_segment){
            at, at, {length_or(p, letter, 0.0), 0.0}, (uint8_t)kind, false};
    }
    return s != NULL;
}

static bool set_centre(struct program *p, const struct program_code *code, const struct point *end,
                       struct profile_segment *s)
{
    struct point centre = *end;
    enum axis first;
    enum axis second;
    double centre_mm[2];

    TAKT_ASSERT(s != NULL);
    if (code->run != takt_circular_move) {
        s->kind = PROFILE_LINE;
        return true;
    }
    if (!takt_circular_find_centre(p, code, end, centre_mm)) {
        return false;
    }
    takt_plane_axes(PLANE_ZX, &first, &second);
    centre.at[first] = centre_mm[0];
    centre.at[second] = centre_mm[1];
    s->kind = PROFILE_ARC;
    s->left = code->argument == MOVE_ARC_CCW;
    s->centre = point_of(p, &centre);
    return true;
}

static bool add_line(struct program *p, const struct program_code *code)
{
    struct program_contour *c = &p->cycle.contour;
    struct point end;

    end_of_line(p, &end);
    p->modes.motion = code;
    if (point_is_same(&end, &p->modes.at)) {
        return true;
    }
    struct profile_segment *s = add_segment(p);

    if (s == NULL || !set_centre(p, code, &end, s)) {
        return false;
    }
    s->start = c->at;
    s->end = point_of(p, &end);
    c->at = s->end;
    p->modes.at = end;
    return add_corner(p, 'a', PROFILE_FILLET) && add_corner(p, 'c', PROFILE_CHAMFER);
}

bool takt_contour_take_line(struct program *p)
{
    const struct program_code *code = p->words.code[STEP_MOTION];
    const bool moves = words_has_step(p, STEP_MOTION) &&
                       (code->run == takt_straight_move || code->run == takt_circular_move);

    if (takt_words_assign(p) && (!moves || p->cycle.contour.failed || add_line(p, code))) {
        return true;
    }
    takt_words_take_back(p);
    p->cycle.contour.failed = true;
    return false;
}

/* -- the cycle -- */

/*
 * A profile that ends aslant leaves no wall where the cycle's levels could end: without one the
 * whole depth would be cut at once. It gets a line to the level at which the cycle begins, as in
 * LinuxCNC 2.10.
 */
static bool close_profile(struct program *p)
{
    struct program_contour *c = &p->cycle.contour;
    const struct profile *f = &p->turning.profile;
    const struct profile_segment *first = &f->segment[0];
    const struct profile_segment *last = &f->segment[f->count - 1];
    const struct profile_point begin = point_of(p, &c->start);
    const bool facing = c->words.facing;
    const double aslant = facing ? last->end.v - last->start.v : last->end.u - last->start.u;
    const double in = facing ? first->end.u - first->start.u : first->end.v - first->start.v;
    const double out = facing ? begin.u - c->at.u : begin.v - c->at.v;

    if (c->words.kind == TURNING_FINISH || aslant == 0.0 || in * out >= 0.0) {
        return true;
    }
    struct profile_segment *s = add_segment(p);

    if (s != NULL) {
        *s = (struct profile_segment){.start = c->at, .end = c->at, .kind = PROFILE_LINE};
        *(facing ? &s->end.u : &s->end.v) = facing ? begin.u : begin.v;
    }
    return s != NULL;
}

static bool open_cycle(struct program *p)
{
    switch (takt_turning_open(&p->turning)) {
    case TURNING_NOT_MONOTONE:
        return report(p, TAKT_ERROR_PROFILE_BACK, 0.0);
    case TURNING_CORNER:
        return report(p, TAKT_ERROR_PROFILE_CORNER, 0.0);
    case TURNING_SWALLOWED:
        return report(p, TAKT_ERROR_PROFILE_GONE, 0.0);
    case TURNING_GOOD:
        break;
    }
    return true;
}

/* False: it has no length. */
static bool make_move(struct program *p, const struct turning_move *t, struct move *m)
{
    struct point work;
    struct point centre;
    enum axis first;
    enum axis second;

    takt_coordinates_work_of(p, &p->modes.at, &work);
    work.at[AXIS_X] = t->centre.v;
    work.at[AXIS_Z] = t->centre.u;
    takt_coordinates_machine_of(p, &work, &centre);
    work.at[AXIS_X] = t->end.v;
    work.at[AXIS_Z] = t->end.u;
    *m = p->cycle.feed;
    takt_coordinates_machine_of(p, &work, &m->end);
    if (point_is_same(&m->end, &p->modes.at)) {
        return false;
    }
    if (t->rapid) {
        m->kind = MOVE_RAPID;
        m->feed_mm_s = 0.0;
        m->feed_rev_mm = 0.0;
    } else if (t->arc) {
        takt_plane_axes(PLANE_ZX, &first, &second);
        m->kind = t->left ? MOVE_ARC_CCW : MOVE_ARC_CW;
        m->plane = PLANE_ZX;
        m->centre_mm[0] = centre.at[first];
        m->centre_mm[1] = centre.at[second];
        m->turns = 1;
    }
    takt_cutter_apply(p, m);
    m->contour_side = (uint8_t)m->cutter_side;
    return true;
}

bool takt_contour_next(struct program *p, struct move *move)
{
    struct turning_move t;

    TAKT_ASSERT(p->cycle.contour.code != NULL);
    while (takt_turning_next(&p->turning, &t)) {
        if (make_move(p, &t, move)) {
            p->modes.at = move->end;
            return true;
        }
    }
    p->cycle.code = NULL;
    return false;
}

/* Goes the whole way once, without moving. */
static bool check_moves(struct program *p)
{
    const struct program_modes before = p->modes;
    struct move m;
    uint32_t count = 0;
    bool good = true;

    struct turning_move t;

    while (good && takt_turning_next(&p->turning, &t)) {
        if (!make_move(p, &t, &m)) {
            continue;
        }
        good = takt_travel_check(p, &m);
        p->modes.at = m.end;
        if (count++ == MOVES_MAX) {
            good = report(p, TAKT_ERROR_CYCLE_TOO_LONG, MOVES_MAX);
        }
    }
    p->modes = before;
    takt_turning_begin(&p->turning);
    return good;
}

static bool begin_cycle(struct program *p)
{
    struct program_contour *c = &p->cycle.contour;

    if (!c->begun || p->turning.profile.count < 2) {
        return true;
    }
    p->turning.words = c->words;
    if (!close_profile(p) || !open_cycle(p) || !check_moves(p)) {
        return false;
    }
    p->cycle.code = c->code;
    p->cycle.before = p->queue_count;
    return true;
}

bool takt_contour_follow(struct program *p, bool good)
{
    struct program_contour *c = &p->cycle.contour;

    if (!contour_is_open(p) || p->flow.calls > c->calls) {
        return good;
    }
    p->cycle.contour_open = false;
    p->modes.at = c->start;
    return good && (c->failed || begin_cycle(p));
}
