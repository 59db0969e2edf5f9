#include "program/straight.h"

#include "base/maths.h"
#include "program/coordinates.h"
#include "program/emit.h"
#include "program/report.h"
#include "program/words.h"

static bool move_to(struct program *p, enum move_kind kind, const struct point *end)
{
    struct move m;

    takt_emit_prepare(p, kind, end, &m);
    return takt_emit_motion(p, &m);
}

bool takt_straight_move(struct program *p, const struct program_code *code)
{
    struct point end;

    p->modes.motion = code;
    takt_coordinates_end(p, &end);
    return move_to(p, (enum move_kind)code->argument, &end);
}

static void reference_point(const struct program *p, unsigned first, struct point *end)
{
    const bool all = (p->words.given & LETTERS_AXES) == 0;
    double ignored;

    *end = p->modes.at;
    for (enum axis i = AXIS_X; i < AXIS_COUNT; i++) {
        const bool present = (p->config.axes & (1U << i)) != 0;

        if (present && (all || takt_coordinates_word(p, i, &ignored))) {
            end->at[i] = takt_coordinates_from_parameter(
                takt_parameters_get(p->config.parameters, first + i), i);
        }
    }
}

bool takt_straight_to_reference(struct program *p, const struct program_code *code)
{
    struct point end;

    if ((p->words.given & LETTERS_AXES) != 0) {
        takt_coordinates_end(p, &end);
        if (!move_to(p, MOVE_RAPID, &end)) {
            return false;
        }
    }
    reference_point(p, (unsigned)code->argument, &end);
    return move_to(p, MOVE_RAPID, &end);
}

bool takt_straight_store_reference(struct program *p, const struct program_code *code)
{
    for (enum axis i = AXIS_X; i < AXIS_COUNT; i++) {
        if (!takt_words_store(p, code->step, (unsigned)code->argument + i,
                              takt_coordinates_to_parameter(p->modes.at.at[i], i))) {
            return false;
        }
    }
    return true;
}

/* The end and the pitch of a motion that follows the spindle. Its feed is not to be overridden. */
static bool prepare_thread(struct program *p, const struct program_code *code, enum move_kind kind,
                           struct move *m)
{
    struct point end;

    if ((p->words.given & LETTERS_AXES) == 0) {
        return takt_report_error_code(p, TAKT_ERROR_AXIS_WORD_MISSING, code->step, 0.0);
    }
    if (!words_has(p, 'k')) {
        return takt_report_missing(p, code->step, 'k');
    }
    if (words_value(p, 'k') <= 0.0) {
        return takt_report_error_letter(p, TAKT_ERROR_WORD_NOT_POSITIVE, 'k', words_value(p, 'k'));
    }
    p->modes.motion = code;
    takt_coordinates_end(p, &end);
    takt_emit_prepare(p, kind, &end, m);
    m->overrides &= ~(OVERRIDE_FEED | OVERRIDE_SPINDLE);
    m->feed_rev_mm = words_value(p, 'k') * p->modes.unit_mm;
    return true;
}

bool takt_straight_thread(struct program *p, const struct program_code *code)
{
    struct move m;

    return prepare_thread(p, code, MOVE_THREAD, &m) && takt_emit_motion(p, &m);
}

bool takt_straight_tap(struct program *p, const struct program_code *code)
{
    const struct point start = p->modes.at;
    const double ratio = words_has(p, 'i') ? maths_max(words_value(p, 'i'), 1.0) : 1.0;
    struct move m;

    if (!prepare_thread(p, code, MOVE_TAP, &m) || !takt_emit_motion(p, &m)) {
        return false;
    }
    m.kind = MOVE_TAP_OUT;
    m.end = start;
    m.speed_ratio = ratio;
    if (!takt_emit_set_feed(p, &m)) {
        return false;
    }
    m.feed_mm_s *= ratio;
    *takt_emit_event(p, m.kind) = m;
    p->modes.at = start;
    return true;
}

bool takt_straight_cancel(struct program *p, const struct program_code *code)
{
    (void)code;
    p->modes.motion = NULL;
    return true;
}
