#include "program/threading.h"

#include "base/maths.h"
#include "program/coordinates.h"
#include "program/cycles.h"
#include "program/emit.h"
#include "program/report.h"
#include "program/words.h"

#include <string.h>

#define TAPER_IN         1U
#define TAPER_OUT        2U
#define TAPER_MAX        3.0
#define SPRING_CUTS_MAX  99.0
#define RAD_PER_DEGREE   (MATHS_PI / 180.0)
#define FLANK_MAX_DEGREE 80.0

static double word_or(const struct program *p, char letter, double otherwise)
{
    return words_has(p, letter) ? words_value(p, letter) : otherwise;
}

/* I, J and K are diameters with G7, as X is. */
static double depth_word(const struct program *p, char letter)
{
    return words_value(p, letter) * p->modes.unit_mm * (p->modes.diameter ? 0.5 : 1.0);
}

static bool check_words(struct program *p, const struct program_code *code)
{
    static const char needed[] = "pijk";

    if ((p->words.given & LETTERS_LINEAR) == 0) {
        return takt_report_error_code(p, TAKT_ERROR_AXIS_WORD_MISSING, code->step, 0.0);
    }
    for (unsigned i = 0; i < sizeof(needed) - 1; i++) {
        if (!words_has(p, needed[i])) {
            return takt_report_missing(p, code->step, needed[i]);
        }
    }
    if (words_value(p, 'p') <= 0.0) {
        return takt_report_error_letter(p, TAKT_ERROR_WORD_NOT_POSITIVE, 'p', words_value(p, 'p'));
    }
    if (words_value(p, 'i') == 0.0) {
        return takt_report_error_letter(p, TAKT_ERROR_WORD_ZERO, 'i', 0.0);
    }
    if (words_value(p, 'j') <= 0.0) {
        return takt_report_error_letter(p, TAKT_ERROR_WORD_NOT_POSITIVE, 'j', words_value(p, 'j'));
    }
    if (words_value(p, 'k') <= words_value(p, 'j')) {
        return takt_report_error_letter(p, TAKT_ERROR_THREAD_DEPTH, 'k', 0.0);
    }
    return true;
}

/* The number of cuts is (K / J)^R. */
static bool set_cuts(struct program *p, const struct program_code *code, struct program_thread *t)
{
    const double crest_mm = maths_abs(depth_word(p, 'i'));

    t->side = words_value(p, 'i') > 0.0 ? 1.0 : -1.0;
    t->cut_mm = depth_word(p, 'j');
    t->height_mm = depth_word(p, 'k');
    t->first_mm = crest_mm;
    t->depth_mm = crest_mm + t->cut_mm;
    t->last_mm = crest_mm + t->height_mm;
    t->degression = maths_max(word_or(p, 'r', 1.0), 1.0);
    t->pass = 1;
    t->springs = 0;
    if (!(takt_maths_power(t->height_mm / t->cut_mm, t->degression) <= PROGRAM_REPEATS_MAX)) {
        return takt_report_error_code(p, TAKT_ERROR_CYCLE_TOO_LONG, code->step,
                                      PROGRAM_REPEATS_MAX);
    }
    return !words_has(p, 'h') || takt_words_whole(p, 'h', 0.0, SPRING_CUTS_MAX, &t->springs);
}

/*
 * Along the taper of length E the tool advances by the pitch in Z while it goes hypot(E, K) for
 * each E:
 *
 *     pitch along the path = P hypot(E, K) / E
 */
static bool set_taper(struct program *p, struct program_thread *t)
{
    const double length_mm = maths_max(word_or(p, 'e', 0.0) * p->modes.unit_mm, 0.0);
    uint32_t which = 0;

    if (words_has(p, 'l') && !takt_words_whole(p, 'l', 0.0, TAPER_MAX, &which)) {
        return false;
    }
    t->pitch_mm = words_value(p, 'p') * p->modes.unit_mm;
    t->taper_in = length_mm > 0.0 && (which & TAPER_IN) != 0;
    t->taper_out = length_mm > 0.0 && (which & TAPER_OUT) != 0;
    t->taper_mm = t->end_mm[AXIS_Z] > t->start_mm[AXIS_Z] ? -length_mm : length_mm;
    t->taper_pitch_mm = t->pitch_mm;
    if (length_mm > 0.0) {
        t->taper_pitch_mm *=
            maths_sqrt(length_mm * length_mm + t->height_mm * t->height_mm) / length_mm;
    }
    return true;
}

static bool set_flank(struct program *p, struct program_thread *t)
{
    const double degrees = word_or(p, 'q', 0.0);
    const double sign = t->end_mm[AXIS_Z] > t->start_mm[AXIS_Z] ? -1.0 : 1.0;

    if (maths_abs(degrees) > FLANK_MAX_DEGREE) {
        return takt_report_error_letter(p, TAKT_ERROR_WORD_OUT_OF_RANGE, 'q', degrees);
    }
    t->slope = sign * takt_maths_tan(degrees * RAD_PER_DEGREE);
    t->length_end_mm = t->end_mm[AXIS_Z] + t->height_mm * t->slope;
    return true;
}

static void set_ends(const struct program *p, struct program_thread *t)
{
    struct point end;
    struct point work;

    takt_coordinates_end(p, &end);
    takt_coordinates_work_of(p, &p->modes.at, &work);
    memcpy(t->start_mm, work.at, sizeof(t->start_mm));
    takt_coordinates_work_of(p, &end, &work);
    memcpy(t->end_mm, work.at, sizeof(t->end_mm));
}

/* How far the start of the current cut is shifted along the thread. */
static double shift_mm(const struct program_thread *t)
{
    return (t->depth_mm - t->first_mm) * t->slope;
}

/* Where a cut goes: X by its distance from the drive line. */
static void place(const struct program *p, double away_mm, double z_mm, struct point *work)
{
    const struct program_thread *t = &p->cycle.thread;

    takt_coordinates_work_of(p, &p->modes.at, work);
    work->at[AXIS_X] = t->start_mm[AXIS_X] + t->side * away_mm;
    work->at[AXIS_Y] = t->start_mm[AXIS_Y];
    work->at[AXIS_Z] = z_mm;
}

/* The corners of the current cut, and where its tapers end. */
static bool check_cut(struct program *p)
{
    const struct program_thread *t = &p->cycle.thread;
    const double begin_mm = t->start_mm[AXIS_Z] - shift_mm(t);
    const double end_mm = t->length_end_mm - shift_mm(t);
    const double away_mm[] = {t->depth_mm - t->last_mm, t->depth_mm};
    const double z_mm[] = {begin_mm, end_mm, t->taper_in ? begin_mm - t->taper_mm : begin_mm,
                           t->taper_out ? end_mm + t->taper_mm : end_mm};
    struct point work;

    for (unsigned i = 0; i < 8; i++) {
        place(p, away_mm[i / 4], z_mm[i % 4], &work);
        if (!takt_cycles_check_travel(p, &work)) {
            return false;
        }
    }
    return true;
}

/* The first and the last cut; all others lie between them. */
static bool check_travel(struct program *p)
{
    struct program_thread *t = &p->cycle.thread;
    const double depth_mm = t->depth_mm;
    struct point work;

    if (!check_cut(p)) {
        return false;
    }
    t->depth_mm = t->last_mm;
    const bool good = check_cut(p);

    t->depth_mm = depth_mm;
    takt_coordinates_work_of(p, &p->modes.at, &work);
    memcpy(work.at, t->end_mm, sizeof(t->end_mm));
    return good && takt_cycles_check_travel(p, &work);
}

bool takt_threading_start(struct program *p, const struct program_code *code)
{
    struct program_cycle *c = &p->cycle;
    struct program_thread *t = &c->thread;

    memset(c, 0, sizeof(*c));
    if (!check_words(p, code)) {
        return false;
    }
    set_ends(p, t);
    if (!set_cuts(p, code, t) || !set_taper(p, t) || !set_flank(p, t) || !check_travel(p)) {
        return false;
    }
    takt_emit_prepare(p, MOVE_THREAD, &p->modes.at, &c->feed);
    c->feed.overrides &= ~(OVERRIDE_FEED | OVERRIDE_SPINDLE);
    c->feed.feed_rev_mm = t->pitch_mm;
    if (!takt_emit_set_feed(p, &c->feed)) {
        return false;
    }
    c->code = code;
    c->before = p->queue_count;
    p->modes.motion = code;
    return true;
}

static bool rapid(struct program *p, double away_mm, double z_mm, struct move *move)
{
    struct point work;

    place(p, away_mm, z_mm, &work);
    return takt_cycles_move(p, MOVE_RAPID, &work, move);
}

static bool cut(struct program *p, double away_mm, double z_mm, double pitch_mm, struct move *move)
{
    struct point work;

    place(p, away_mm, z_mm, &work);
    if (!takt_cycles_move(p, MOVE_THREAD, &work, move)) {
        return false;
    }
    move->feed_mm_s *= pitch_mm / move->feed_rev_mm;
    move->feed_rev_mm = pitch_mm;
    return true;
}

/* One move of a cut, by number; false: it is not needed. */
static bool make_move(struct program *p, unsigned number, struct move *move)
{
    const struct program_thread *t = &p->cycle.thread;
    const double begin_mm = t->start_mm[AXIS_Z] - shift_mm(t);
    const double end_mm = t->length_end_mm - shift_mm(t);
    const double in_mm = t->depth_mm;
    const double crest_mm = t->depth_mm - t->height_mm;

    switch (number) {
    case 0:
        return rapid(p, t->depth_mm - t->last_mm, begin_mm, move);
    case 1:
        return t->taper_in ? cut(p, crest_mm, begin_mm, t->taper_pitch_mm, move)
                           : rapid(p, in_mm, begin_mm, move);
    case 2:
        return t->taper_in && cut(p, in_mm, begin_mm - t->taper_mm, t->taper_pitch_mm, move);
    case 3:
        return cut(p, in_mm, t->taper_out ? end_mm + t->taper_mm : end_mm, t->pitch_mm, move);
    case 4:
        return t->taper_out && cut(p, crest_mm, end_mm, t->taper_pitch_mm, move);
    default:
        return rapid(p, t->depth_mm - t->last_mm, end_mm, move);
    }
}

#define MOVES_OF_CUT 6U

/* Depth of cut number n: J n^(1/R) below the crest. False: that was the last one. */
static bool next_cut(struct program_thread *t)
{
    if (t->depth_mm >= t->last_mm) {
        return t->springs-- > 0;
    }
    t->pass++;
    t->depth_mm =
        maths_min(t->first_mm + t->cut_mm * takt_maths_power((double)t->pass, 1.0 / t->degression),
                  t->last_mm);
    return true;
}

/* At last along the drive line. */
static bool finish(struct program *p, struct move *move)
{
    struct point work;

    takt_coordinates_work_of(p, &p->modes.at, &work);
    memcpy(work.at, p->cycle.thread.end_mm, sizeof(p->cycle.thread.end_mm));
    p->cycle.code = NULL;
    return takt_cycles_move(p, MOVE_RAPID, &work, move);
}

bool takt_threading_next(struct program *p, struct move *move)
{
    struct program_cycle *c = &p->cycle;

    for (;;) {
        if (c->stage == MOVES_OF_CUT) {
            c->stage = 0;
            if (!next_cut(&c->thread)) {
                return finish(p, move);
            }
        }
        if (make_move(p, c->stage++, move)) {
            return true;
        }
    }
}
