#include "program/cycles.h"

#include "base/maths.h"
#include "program/coordinates.h"
#include "program/emit.h"
#include "program/events.h"
#include "program/report.h"
#include "program/threading.h"
#include "program/travel.h"
#include "program/words.h"

#include <string.h>

/* Rapid into a hole ends so far above where it was cut last: 0.010 inch, as in LinuxCNC. */
#define PECK_CLEARANCE_MM 0.254

enum act {
    ACT_END,
    ACT_RAPID,
    ACT_FEED,
    ACT_PECKS,     /* down to the bottom in steps of Q, each time back to R */
    ACT_CHIPS,     /* the same, each time back a little */
    ACT_DWELL,     /* P seconds */
    ACT_STOP,      /* spindle */
    ACT_ORIENT,    /* spindle */
    ACT_TURN,      /* spindle, as before */
    ACT_TURN_BACK, /* spindle, the other way */
    ACT_PAUSE      /* as M0 */
};

enum height { NOWHERE, OVER, AT_R, CLEAR, BOTTOM, MIDDLE };

/* ASIDE: by I and J of G87 from the hole. */
enum place { HOLE, ASIDE };

struct row {
    enum act act;
    enum height height;
    enum place place;
};

#define SCRIPT_MAX 15

static const struct row approach[] = {{ACT_RAPID, OVER, HOLE}, {ACT_RAPID, AT_R, HOLE}};

#define APPROACH_ROWS (sizeof(approach) / sizeof(approach[0]))

static const struct row scripts[CYCLE_COUNT][SCRIPT_MAX] = {
    [CYCLE_DRILL] = {{ACT_FEED, BOTTOM, HOLE}, {ACT_RAPID, CLEAR, HOLE}},
    [CYCLE_DRILL_WAIT] = {{ACT_FEED, BOTTOM, HOLE},
                          {ACT_DWELL, NOWHERE, HOLE},
                          {ACT_RAPID, CLEAR, HOLE}},
    [CYCLE_PECK] = {{ACT_PECKS, BOTTOM, HOLE}, {ACT_RAPID, CLEAR, HOLE}},
    [CYCLE_CHIP_BREAK] = {{ACT_CHIPS, BOTTOM, HOLE}, {ACT_RAPID, CLEAR, HOLE}},
    [CYCLE_TAP] = {{ACT_FEED, BOTTOM, HOLE},
                   {ACT_STOP, NOWHERE, HOLE},
                   {ACT_TURN_BACK, NOWHERE, HOLE},
                   {ACT_DWELL, NOWHERE, HOLE},
                   {ACT_FEED, CLEAR, HOLE},
                   {ACT_STOP, NOWHERE, HOLE},
                   {ACT_TURN, NOWHERE, HOLE}},
    [CYCLE_TAP_LEFT] = {{ACT_FEED, BOTTOM, HOLE},
                        {ACT_STOP, NOWHERE, HOLE},
                        {ACT_TURN_BACK, NOWHERE, HOLE},
                        {ACT_DWELL, NOWHERE, HOLE},
                        {ACT_FEED, CLEAR, HOLE},
                        {ACT_STOP, NOWHERE, HOLE},
                        {ACT_TURN, NOWHERE, HOLE}},
    [CYCLE_REAM] = {{ACT_FEED, BOTTOM, HOLE}, {ACT_FEED, AT_R, HOLE}, {ACT_RAPID, CLEAR, HOLE}},
    [CYCLE_BORE_STOP] = {{ACT_FEED, BOTTOM, HOLE},
                         {ACT_DWELL, NOWHERE, HOLE},
                         {ACT_STOP, NOWHERE, HOLE},
                         {ACT_RAPID, CLEAR, HOLE},
                         {ACT_TURN, NOWHERE, HOLE}},
    [CYCLE_BORE_BACK] = {{ACT_RAPID, AT_R, ASIDE},
                         {ACT_STOP, NOWHERE, HOLE},
                         {ACT_ORIENT, NOWHERE, HOLE},
                         {ACT_RAPID, BOTTOM, ASIDE},
                         {ACT_RAPID, BOTTOM, HOLE},
                         {ACT_TURN, NOWHERE, HOLE},
                         {ACT_FEED, MIDDLE, HOLE},
                         {ACT_FEED, BOTTOM, HOLE},
                         {ACT_STOP, NOWHERE, HOLE},
                         {ACT_ORIENT, NOWHERE, HOLE},
                         {ACT_RAPID, BOTTOM, ASIDE},
                         {ACT_RAPID, CLEAR, ASIDE},
                         {ACT_RAPID, CLEAR, HOLE},
                         {ACT_TURN, NOWHERE, HOLE}},
    [CYCLE_BORE_PAUSE] = {{ACT_FEED, BOTTOM, HOLE},
                          {ACT_DWELL, NOWHERE, HOLE},
                          {ACT_STOP, NOWHERE, HOLE},
                          {ACT_PAUSE, NOWHERE, HOLE},
                          {ACT_RAPID, CLEAR, HOLE},
                          {ACT_TURN, NOWHERE, HOLE}},
    [CYCLE_BORE_WAIT] = {{ACT_FEED, BOTTOM, HOLE},
                         {ACT_DWELL, NOWHERE, HOLE},
                         {ACT_FEED, CLEAR, HOLE}},
};

void cycles_open(struct program *p)
{
    p->cycle.code = NULL;
}

void cycles_see(struct program *p, const struct program_code *code)
{
    if (code->step == STEP_MOTION && code->run != cycles_start) {
        p->modes.cycle.initial_known = false;
    }
}

/* A word of a cycle in mm, or what the same cycle had before. False: it has neither, p->error is set. */
static bool keep_word(struct program *p, const struct program_code *code, char letter, double unit,
                      double *kept)
{
    if (words_has(p, letter)) {
        *kept = words_value(p, letter) * unit;
        return true;
    }
    return p->modes.motion == code || report_missing(p, code->step, letter);
}

static bool keep_dwell(struct program *p, const struct program_code *code)
{
    double *dwell_s = &p->modes.cycle.dwell_s;
    const bool tapping = code->argument == CYCLE_TAP || code->argument == CYCLE_TAP_LEFT;

    if ((code->words & LETTER_BIT('p')) == 0 || (tapping && !words_has(p, 'p'))) {
        return true;
    }
    return keep_word(p, code, 'p', 1.0, dwell_s) &&
           (*dwell_s >= 0.0 || report_error_letter(p, TAKT_ERROR_WORD_NEGATIVE, 'p', *dwell_s));
}

static bool keep_peck(struct program *p, const struct program_code *code)
{
    double *peck_mm = &p->modes.cycle.peck_mm;

    if ((code->words & LETTER_BIT('q')) == 0) {
        return true;
    }
    return keep_word(p, code, 'q', p->modes.unit_mm, peck_mm) &&
           (*peck_mm > 0.0 || report_error_letter(p, TAKT_ERROR_WORD_NOT_POSITIVE, 'q', *peck_mm));
}

/* I J K of G87: offsets in the plane, and the height across it. */
static bool keep_aside(struct program *p, const struct program_code *code)
{
    struct program_cycle_words *w = &p->modes.cycle;
    const struct program_cycle *c = &p->cycle;
    double *const kept[3] = {&w->aside_mm[0], &w->aside_mm[1], &w->middle_mm};

    for (unsigned i = 0; code->argument == CYCLE_BORE_BACK && i < 3; i++) {
        if (!keep_word(p, code, (char)('i' + (int)c->axis[i]), p->modes.unit_mm, kept[i])) {
            return false;
        }
    }
    return true;
}

static bool keep_words(struct program *p, const struct program_code *code)
{
    struct program_cycle_words *w = &p->modes.cycle;
    const char across = coordinates_letter(p->cycle.axis[2]);

    return keep_word(p, code, 'r', p->modes.unit_mm, &w->retract_mm) &&
           keep_word(p, code, across, p->modes.unit_mm, &w->bottom_mm) && keep_dwell(p, code) &&
           keep_peck(p, code) && keep_aside(p, code);
}

static bool check_spindle(struct program *p, const struct program_code *code)
{
    const enum spindle_direction direction = p->modes.direction;
    const bool turning = direction != SPINDLE_OFF;

    switch ((enum cycle)code->argument) {
    case CYCLE_TAP:
    case CYCLE_TAP_LEFT:
        if (turning && direction == (code->argument == CYCLE_TAP ? SPINDLE_CCW : SPINDLE_CW)) {
            return report_error_code(p, TAKT_ERROR_SPINDLE_WRONG_WAY, code->step, 0.0);
        }
        break;
    case CYCLE_BORE_STOP:
    case CYCLE_BORE_BACK:
    case CYCLE_BORE_PAUSE:
        break;
    case CYCLE_CHIP_BREAK:
    case CYCLE_DRILL:
    case CYCLE_DRILL_WAIT:
    case CYCLE_PECK:
    case CYCLE_REAM:
    case CYCLE_BORE_WAIT:
    case CYCLE_COUNT:
        return true;
    }
    return turning || report_error_code(p, TAKT_ERROR_SPINDLE_STANDS, code->step, 0.0);
}

static void set_axes(struct program *p, struct program_cycle *c)
{
    plane_axes(p->modes.plane, &c->axis[0], &c->axis[1]);
    c->axis[2] = (enum axis)(AXIS_X + AXIS_Y + AXIS_Z - c->axis[0] - c->axis[1]);
}

/* The holes in the plane: with G90 the words are the one hole, with G91 the step to the first and to each next. */
static void set_holes(const struct program *p, struct program_cycle *c, const struct point *work)
{
    for (unsigned i = 0; i < 2; i++) {
        double word = 0.0;
        const bool given = coordinates_word(p, c->axis[i], &word);

        c->hole_mm[i] = given && !p->modes.incremental ? word : work->at[c->axis[i]];
        c->step_mm[i] = given && p->modes.incremental ? word : 0.0;
        c->hole_mm[i] += c->step_mm[i];
    }
}

/* With G91, R counts from the height before the row of cycles, Z from R, and K of G87 from Z. */
static void set_heights(struct program *p, struct program_cycle *c, const struct point *work)
{
    struct program_cycle_words *w = &p->modes.cycle;

    c->start_mm = work->at[c->axis[2]];
    if (!w->initial_known) {
        w->initial_mm = c->start_mm;
        w->initial_known = true;
    }
    c->retract_mm = w->retract_mm + (p->modes.incremental ? w->initial_mm : 0.0);
    c->bottom_mm = w->bottom_mm + (p->modes.incremental ? c->retract_mm : 0.0);
    c->middle_mm = w->middle_mm + (p->modes.incremental ? c->bottom_mm : 0.0);
    c->clear_mm = p->modes.retract_to_r ? c->retract_mm : maths_max(c->retract_mm, w->initial_mm);
    c->peck_mm = w->peck_mm;
    c->dwell_s = w->dwell_s;
    c->aside_mm[0] = w->aside_mm[0];
    c->aside_mm[1] = w->aside_mm[1];
}

static bool check_size(struct program *p, const struct program_code *code,
                       const struct program_cycle *c)
{
    const double depth_mm = c->retract_mm - c->bottom_mm;

    if (depth_mm < 0.0) {
        return report_error_code(p, TAKT_ERROR_CYCLE_UPSIDE_DOWN, code->step, -depth_mm);
    }
    if ((code->words & LETTER_BIT('q')) != 0 && depth_mm > c->peck_mm * PROGRAM_REPEATS_MAX) {
        return report_error_code(p, TAKT_ERROR_CYCLE_TOO_LONG, code->step, PROGRAM_REPEATS_MAX);
    }
    return true;
}

bool cycles_check_travel(struct program *p, const struct point *work)
{
    struct point end;
    struct move m;

    coordinates_machine_of(p, work, &end);
    emit_prepare(p, MOVE_RAPID, &end, &m);
    return travel_check(p, &m);
}

/* The highest and lowest places over the first and the last hole; all others lie between them. */
static bool check_travel(struct program *p, const struct program_cycle *c)
{
    const bool back = c->code->argument == CYCLE_BORE_BACK;
    const double height_mm[] = {c->bottom_mm, c->retract_mm, c->clear_mm, c->start_mm,
                                back ? c->middle_mm : c->bottom_mm};
    struct point work;

    coordinates_work_of(p, &p->modes.at, &work);
    for (unsigned i = 0; i < 4U * (sizeof(height_mm) / sizeof(height_mm[0])); i++) {
        const double steps = (i & 1U) != 0 ? (double)c->repeats - 1.0 : 0.0;
        const double aside = back && (i & 2U) != 0 ? 1.0 : 0.0;

        for (unsigned k = 0; k < 2; k++) {
            work.at[c->axis[k]] = c->hole_mm[k] + steps * c->step_mm[k] + aside * c->aside_mm[k];
        }
        work.at[c->axis[2]] = height_mm[i / 4U];
        if (!cycles_check_travel(p, &work)) {
            return false;
        }
    }
    return true;
}

/* What all its cutting moves have in common. They stop at no corner but keep to the path. */
static bool prepare_feed(struct program *p, const struct program_code *code,
                         struct program_cycle *c)
{
    const bool tapping = code->argument == CYCLE_TAP || code->argument == CYCLE_TAP_LEFT;

    emit_prepare(p, MOVE_FEED, &p->modes.at, &c->feed);
    c->feed.path = PATH_EXACT;
    c->feed.tolerance_mm = 0.0;
    c->feed.merge_mm = 0.0;
    if (tapping) {
        c->feed.overrides &= ~(OVERRIDE_FEED | OVERRIDE_SPINDLE);
    }
    return emit_set_feed(p, &c->feed);
}

/* From below R the tool first goes straight up to it. */
static bool rise(struct program *p, struct program_cycle *c, const struct point *work)
{
    struct point up = *work;
    struct point end;
    struct move m;

    if (p->modes.cycle.initial_mm >= c->retract_mm) {
        return true;
    }
    up.at[c->axis[2]] = c->retract_mm;
    c->start_mm = c->retract_mm;
    coordinates_machine_of(p, &up, &end);
    emit_prepare(p, MOVE_RAPID, &end, &m);
    return emit_motion(p, &m);
}

static bool check_use(struct program *p, const struct program_code *code)
{
    if ((p->words.given & LETTERS_LINEAR) == 0) {
        return report_error_code(p, TAKT_ERROR_AXIS_WORD_MISSING, code->step, 0.0);
    }
    if (p->modes.inverse_time) {
        return report_error_code(p, TAKT_ERROR_FEED_MODE_UNFIT, code->step, 0.0);
    }
    return !words_has(p, 'l') || words_whole(p, 'l', 1.0, PROGRAM_REPEATS_MAX, &p->cycle.repeats);
}

bool cycles_start(struct program *p, const struct program_code *code)
{
    struct program_cycle *c = &p->cycle;
    struct point work;

    memset(c, 0, sizeof(*c));
    c->repeats = 1;
    c->first = true;
    set_axes(p, c);
    if (!check_use(p, code) || !keep_words(p, code) || !check_spindle(p, code)) {
        return false;
    }
    coordinates_work_of(p, &p->modes.at, &work);
    set_holes(p, c, &work);
    set_heights(p, c, &work);
    if (!check_size(p, code, c) || !prepare_feed(p, code, c) || !rise(p, c, &work)) {
        return false;
    }
    c->code = code;
    if (!check_travel(p, c)) {
        c->code = NULL;
        return false;
    }
    c->before = p->queue_count;
    p->modes.motion = code;
    return true;
}

bool cycles_move(struct program *p, enum move_kind kind, const struct point *work,
                 struct move *move)
{
    *move = p->cycle.feed;
    move->kind = kind;
    if (kind == MOVE_RAPID) {
        move->feed_mm_s = 0.0;
        move->feed_rev_mm = 0.0;
        move->overrides = p->modes.overrides;
    }
    coordinates_machine_of(p, work, &move->end);
    if (point_is_same(&move->end, &p->modes.at)) {
        return false;
    }
    p->modes.at = move->end;
    return true;
}

static double height_mm(const struct program_cycle *c, enum height height)
{
    switch (height) {
    case OVER:
        return c->first && c->start_mm > c->retract_mm ? c->start_mm : c->clear_mm;
    case AT_R:
        return c->retract_mm;
    case CLEAR:
        return c->clear_mm;
    case MIDDLE:
        return c->middle_mm;
    case BOTTOM:
    case NOWHERE:
        break;
    }
    return c->bottom_mm;
}

static bool go(struct program *p, enum move_kind kind, double height, enum place place,
               struct move *move)
{
    const struct program_cycle *c = &p->cycle;
    struct point work;

    coordinates_work_of(p, &p->modes.at, &work);
    for (unsigned i = 0; i < 2; i++) {
        work.at[c->axis[i]] = c->hole_mm[i] + (place == ASIDE ? c->aside_mm[i] : 0.0);
    }
    work.at[c->axis[2]] = height;
    return cycles_move(p, kind, &work, move);
}

/* One move of the pecks; *done after the last. */
static bool peck(struct program *p, enum act act, bool *done, struct move *move)
{
    struct program_cycle *c = &p->cycle;
    const double next_mm = (c->substage == 0 ? c->retract_mm : c->depth_mm) - c->peck_mm;

    switch (c->substage) {
    case 0:
    case 1:
        if (!(next_mm > c->bottom_mm)) {
            *done = true;
            return go(p, MOVE_FEED, c->bottom_mm, HOLE, move);
        }
        c->depth_mm = next_mm;
        c->substage = act == ACT_PECKS ? 2 : 3;
        return go(p, MOVE_FEED, next_mm, HOLE, move);
    case 2:
        c->substage = 3;
        return go(p, MOVE_RAPID, c->retract_mm, HOLE, move);
    default:
        c->substage = 1;
        return go(p, MOVE_RAPID, c->depth_mm + PECK_CLEARANCE_MM, HOLE, move);
    }
}

static bool event(const struct program *p, enum move_kind kind, struct move *move)
{
    memset(move, 0, sizeof(*move));
    move->kind = kind;
    move->line = p->cycle.feed.line;
    return true;
}

static bool turn(const struct program *p, enum spindle_direction direction, struct move *move)
{
    (void)event(p, MOVE_SPINDLE, move);
    events_spindle_move(p, direction, move);
    return true;
}

static bool wait(const struct program *p, struct move *move)
{
    (void)event(p, MOVE_DWELL, move);
    move->dwell_s = p->cycle.dwell_s;
    return move->dwell_s > 0.0;
}

/* What a row of the script makes of *move; false: nothing. */
static bool act(struct program *p, const struct row *row, bool *done, struct move *move)
{
    const enum spindle_direction direction = p->modes.direction;

    switch (row->act) {
    case ACT_RAPID:
        return go(p, MOVE_RAPID, height_mm(&p->cycle, row->height), row->place, move);
    case ACT_FEED:
        return go(p, MOVE_FEED, height_mm(&p->cycle, row->height), row->place, move);
    case ACT_PECKS:
    case ACT_CHIPS:
        *done = false;
        return peck(p, row->act, done, move);
    case ACT_DWELL:
        return wait(p, move);
    case ACT_STOP:
        return turn(p, SPINDLE_OFF, move);
    case ACT_TURN:
        return turn(p, direction, move);
    case ACT_TURN_BACK:
        return turn(p, direction == SPINDLE_CW ? SPINDLE_CCW : SPINDLE_CW, move);
    case ACT_ORIENT:
        return event(p, MOVE_ORIENT, move);
    case ACT_PAUSE:
        return event(p, MOVE_STOP, move);
    case ACT_END:
        break;
    }
    return false;
}

static const struct row *current_row(const struct program_cycle *c)
{
    return c->stage < APPROACH_ROWS ? &approach[c->stage]
                                    : &scripts[c->code->argument][c->stage - APPROACH_ROWS];
}

/* One hole is done. */
static void next_hole(struct program_cycle *c)
{
    c->stage = 0;
    c->first = false;
    c->repeats--;
    for (unsigned i = 0; i < 2; i++) {
        c->hole_mm[i] += c->step_mm[i];
    }
    if (c->repeats == 0) {
        c->code = NULL;
    }
}

static bool drill(struct program *p, struct move *move)
{
    struct program_cycle *c = &p->cycle;

    while (c->code != NULL) {
        const struct row *row = current_row(c);
        bool done = true;

        if (row->act == ACT_END) {
            next_hole(c);
            continue;
        }
        const bool made = act(p, row, &done, move);

        if (done) {
            c->stage++;
            c->substage = 0;
        }
        if (made) {
            return true;
        }
    }
    return false;
}

bool cycles_next(struct program *p, struct move *move)
{
    if (p->cycle.code == NULL || p->cycle.before > 0) {
        return false;
    }
    return p->cycle.code->run == cycles_start ? drill(p, move) : threading_next(p, move);
}

void cycles_count_queued(struct program *p)
{
    if (p->cycle.code != NULL && p->cycle.before > 0) {
        p->cycle.before--;
    }
}
