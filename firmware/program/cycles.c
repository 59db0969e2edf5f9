#include "program/cycles.h"

#include "base/assert.h"
#include "base/maths.h"
#include "program/contour.h"
#include "program/coordinates.h"
#include "program/drilling.h"
#include "program/emit.h"
#include "program/report.h"
#include "program/spline.h"
#include "program/threading.h"
#include "program/travel.h"
#include "program/words.h"

#include <string.h>

/*
 * Rapid into a hole ends so far above where it was cut last, without D: 0.010 inch, as in LinuxCNC.
 */
#define PECK_CLEARANCE_MM 0.254

void takt_cycles_open(struct program *p)
{
    p->cycle.code = NULL;
    p->cycle.spline_open = false;
    p->cycle.contour_open = false;
}

void takt_cycles_see(struct program *p, const struct program_code *code)
{
    if (code->step == STEP_MOTION && code->run != takt_cycles_start) {
        p->modes.cycle.initial_known = false;
    }
}

/*
 * A word of a cycle in mm, or what the same cycle had before. False: it has neither, p->error is
 * set.
 */
static bool keep_word(struct program *p, const struct program_code *code, char letter, double unit,
                      double *kept)
{
    if (words_has(p, letter)) {
        *kept = words_value(p, letter) * unit;
        return true;
    }
    return p->modes.motion == code || takt_report_missing(p, code->step, letter);
}

static bool keep_dwell(struct program *p, const struct program_code *code)
{
    double *dwell_s = &p->modes.cycle.dwell_s;
    const bool tapping = cycles_kind(code) == CYCLE_TAP;

    if ((code->words & LETTER_BIT('p')) == 0 || (tapping && !words_has(p, 'p'))) {
        return true;
    }
    return keep_word(p, code, 'p', 1.0, dwell_s) &&
           (*dwell_s >= 0.0 ||
            takt_report_error_letter(p, TAKT_ERROR_WORD_NEGATIVE, 'p', *dwell_s));
}

static bool keep_peck(struct program *p, const struct program_code *code)
{
    double *peck_mm = &p->modes.cycle.peck_mm;

    if ((code->words & LETTER_BIT('q')) == 0) {
        return true;
    }
    return keep_word(p, code, 'q', p->modes.unit_mm, peck_mm) &&
           (*peck_mm > 0.0 ||
            takt_report_error_letter(p, TAKT_ERROR_WORD_NOT_POSITIVE, 'q', *peck_mm));
}

/* I J K of G87: offsets in the plane, and the height across it. */
static bool keep_aside(struct program *p, const struct program_code *code)
{
    struct program_cycle_words *w = &p->modes.cycle;
    const struct program_cycle *c = &p->cycle;
    double *const kept[3] = {&w->aside_mm[0], &w->aside_mm[1], &w->middle_mm};

    for (unsigned i = 0; cycles_kind(code) == CYCLE_BORE_BACK && i < 3; i++) {
        if (!keep_word(p, code, (char)('i' + (int)c->axis[i]), p->modes.unit_mm, kept[i])) {
            return false;
        }
    }
    return true;
}

static bool keep_words(struct program *p, const struct program_code *code)
{
    struct program_cycle_words *w = &p->modes.cycle;
    const char across = takt_coordinates_letter(p->cycle.axis[2]);

    return keep_word(p, code, 'r', p->modes.unit_mm, &w->retract_mm) &&
           keep_word(p, code, across, p->modes.unit_mm, &w->bottom_mm) && keep_dwell(p, code) &&
           keep_peck(p, code) && keep_aside(p, code);
}

static enum spindle_direction tapping_direction(const struct program_code *code)
{
    return (code->argument & CYCLE_LEFT) != 0 ? SPINDLE_CCW : SPINDLE_CW;
}

static bool check_spindle(struct program *p, const struct program_code *code)
{
    const enum spindle_direction direction = p->modes.direction;
    const bool turning = direction != SPINDLE_OFF;

    switch (cycles_kind(code)) {
    case CYCLE_TAP:
        if (turning && direction != tapping_direction(code)) {
            return takt_report_error_code(p, TAKT_ERROR_SPINDLE_WRONG_WAY, code->step, 0.0);
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
    return turning || takt_report_error_code(p, TAKT_ERROR_SPINDLE_STANDS, code->step, 0.0);
}

static void set_axes(struct program *p, struct program_cycle *c)
{
    takt_plane_axes(p->modes.plane, &c->axis[0], &c->axis[1]);
    TAKT_ASSERT(c->axis[0] != c->axis[1]);
    c->axis[2] = (enum axis)(AXIS_X + AXIS_Y + AXIS_Z - c->axis[0] - c->axis[1]);
}

/*
 * The holes in the plane: with G90 the words are the one hole, with G91 the step to the first and
 * to each next.
 */
static void set_holes(const struct program *p, struct program_cycle *c, const struct point *work)
{
    for (unsigned i = 0; i < 2; i++) {
        double word = 0.0;
        const bool given = takt_coordinates_word(p, c->axis[i], &word);

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
    c->clearance_mm =
        words_has(p, 'd') ? words_value(p, 'd') * p->modes.unit_mm : PECK_CLEARANCE_MM;
    c->dwell_s = w->dwell_s;
    c->aside_mm[0] = w->aside_mm[0];
    c->aside_mm[1] = w->aside_mm[1];
}

static bool check_size(struct program *p, const struct program_code *code,
                       const struct program_cycle *c)
{
    const double depth_mm = c->retract_mm - c->bottom_mm;

    if (depth_mm < 0.0) {
        return takt_report_error_code(p, TAKT_ERROR_CYCLE_UPSIDE_DOWN, code->step, -depth_mm);
    }
    if ((code->words & LETTER_BIT('q')) != 0 && depth_mm > c->peck_mm * PROGRAM_REPEATS_MAX) {
        return takt_report_error_code(p, TAKT_ERROR_CYCLE_TOO_LONG, code->step,
                                      PROGRAM_REPEATS_MAX);
    }
    return true;
}

bool takt_cycles_check_travel(struct program *p, const struct point *work)
{
    struct point end;
    struct move m;

    takt_coordinates_machine_of(p, work, &end);
    takt_emit_prepare(p, MOVE_RAPID, &end, &m);
    return takt_travel_check(p, &m);
}

/* The highest and lowest places over the first and the last hole; all others lie between them. */
static bool check_travel(struct program *p, const struct program_cycle *c)
{
    const bool back = cycles_kind(c->code) == CYCLE_BORE_BACK;
    const double height_mm[] = {c->bottom_mm, c->retract_mm, c->clear_mm, c->start_mm,
                                back ? c->middle_mm : c->bottom_mm};
    struct point work;

    takt_coordinates_work_of(p, &p->modes.at, &work);
    for (unsigned i = 0; i < 4U * (sizeof(height_mm) / sizeof(height_mm[0])); i++) {
        const double steps = (i & 1U) != 0 ? (double)c->repeats - 1.0 : 0.0;
        const double aside = back && (i & 2U) != 0 ? 1.0 : 0.0;

        for (unsigned k = 0; k < 2; k++) {
            work.at[c->axis[k]] = c->hole_mm[k] + steps * c->step_mm[k] + aside * c->aside_mm[k];
        }
        work.at[c->axis[2]] = height_mm[i / 4U];
        if (!takt_cycles_check_travel(p, &work)) {
            return false;
        }
    }
    return true;
}

/* What all its cutting moves have in common. They stop at no corner but keep to the path. */
static bool prepare_feed(struct program *p, const struct program_code *code,
                         struct program_cycle *c)
{
    const bool tapping = cycles_kind(code) == CYCLE_TAP;

    takt_emit_prepare(p, MOVE_FEED, &p->modes.at, &c->feed);
    c->feed.path = PATH_EXACT;
    c->feed.tolerance_mm = 0.0;
    c->feed.merge_mm = 0.0;
    if (tapping) {
        c->feed.overrides &= ~(OVERRIDE_FEED | OVERRIDE_SPINDLE);
    }
    return takt_emit_set_feed(p, &c->feed);
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
    takt_coordinates_machine_of(p, &up, &end);
    takt_emit_prepare(p, MOVE_RAPID, &end, &m);
    return takt_emit_motion(p, &m);
}

static bool check_use(struct program *p, const struct program_code *code)
{
    if ((p->words.given & LETTERS_LINEAR) == 0) {
        return takt_report_error_code(p, TAKT_ERROR_AXIS_WORD_MISSING, code->step, 0.0);
    }
    if (p->modes.inverse_time) {
        return takt_report_error_code(p, TAKT_ERROR_FEED_MODE_UNFIT, code->step, 0.0);
    }
    return !words_has(p, 'l') ||
           takt_words_whole(p, 'l', 0.0, PROGRAM_REPEATS_MAX, &p->cycle.repeats);
}

bool takt_cycles_start(struct program *p, const struct program_code *code)
{
    struct program_cycle *c = &p->cycle;
    struct point work;

    TAKT_ASSERT(code != NULL && code->step == STEP_MOTION);
    memset(c, 0, sizeof(*c));
    c->repeats = 1;
    c->first = true;
    set_axes(p, c);
    if (!check_use(p, code) || !keep_words(p, code) || !check_spindle(p, code)) {
        return false;
    }
    takt_coordinates_work_of(p, &p->modes.at, &work);
    set_holes(p, c, &work);
    set_heights(p, c, &work);
    if (c->repeats == 0) { /* only its words are kept */
        p->modes.motion = code;
        return true;
    }
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

bool takt_cycles_move(struct program *p, enum move_kind kind, const struct point *work,
                      struct move *move)
{
    *move = p->cycle.feed;
    move->kind = kind;
    if (kind == MOVE_RAPID) {
        move->feed_mm_s = 0.0;
        move->feed_rev_mm = 0.0;
        move->overrides = p->modes.overrides;
    }
    takt_coordinates_machine_of(p, work, &move->end);
    if (point_is_same(&move->end, &p->modes.at)) {
        return false;
    }
    p->modes.at = move->end;
    return true;
}

bool takt_cycles_next(struct program *p, struct move *move)
{
    if (p->cycle.code == NULL || p->cycle.before > 0) {
        return false;
    }
    if (p->cycle.code->run == takt_spline_start) {
        return takt_spline_next(p, move);
    }
    if (p->cycle.code->run == takt_contour_start) {
        return takt_contour_next(p, move);
    }
    return p->cycle.code->run == takt_cycles_start ? takt_drilling_next(p, move)
                                                   : takt_threading_next(p, move);
}

void takt_cycles_count_queued(struct program *p)
{
    if (p->cycle.code != NULL && p->cycle.before > 0) {
        TAKT_ASSERT(p->queue_count < PROGRAM_QUEUE_MAX);
        p->cycle.before--;
    }
}
