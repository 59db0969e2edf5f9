#include "program/emit.h"

#include "program/report.h"
#include "program/travel.h"
#include "program/words.h"

#include <assert.h>
#include <string.h>

#define SECONDS_PER_MINUTE 60.0

struct move *emit_event(struct program *p, enum move_kind kind)
{
    assert(p->queue_count < PROGRAM_QUEUE_MAX);
    struct move *m = &p->queue[(p->queue_first + p->queue_count++) % PROGRAM_QUEUE_MAX];

    memset(m, 0, sizeof(*m));
    m->kind = kind;
    m->line = p->lexer.line;
    return m;
}

void emit_prepare(const struct program *p, enum move_kind kind, const struct point *end,
                  struct move *m)
{
    memset(m, 0, sizeof(*m));
    m->kind = kind;
    m->line = p->lexer.line;
    m->end = *end;
    m->path = p->modes.path;
    m->tolerance_mm = p->modes.path == PATH_BLEND ? p->modes.tolerance_mm : 0.0;
}

/* F counts along X Y Z, unless only A B C move: the same rule as the length of a curve. */
static bool moves_rotary_only(const struct program *p, const struct move *m)
{
    double linear_squared = 0.0;
    bool rotary = false;

    if (m->kind == MOVE_ARC_CW || m->kind == MOVE_ARC_CCW) {
        return false;
    }
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const double delta = m->end.at[i] - p->modes.at.at[i];

        if (i < AXIS_LINEAR_COUNT) {
            linear_squared += delta * delta;
        } else {
            rotary = rotary || delta != 0.0;
        }
    }
    return rotary && linear_squared < CURVE_LENGTH_MIN_MM * CURVE_LENGTH_MIN_MM;
}

/*
 * Inverse time: the move takes 1/F minutes, so feed = length F / 60. One without length gets any feed that is not
 * 0, since nobody runs it.
 */
static double inverse_time_feed(const struct program *p, const struct move *m)
{
    struct curve curve;
    const double rate_per_s = words_has(p, 'f') ? words_value(p, 'f') / SECONDS_PER_MINUTE : 0.0;

    return move_curve(m, &p->modes.at, &curve) ? curve.length_mm * rate_per_s : rate_per_s;
}

static bool set_feed(struct program *p, struct move *m)
{
    if (p->modes.inverse_time) {
        m->feed_mm_s = inverse_time_feed(p, m);
    } else if (moves_rotary_only(p, m)) {
        m->feed_mm_s = p->modes.feed_rad_s;
    } else {
        m->feed_mm_s = p->modes.feed_mm_s;
    }
    return m->feed_mm_s > 0.0 || report_error_code(p, TAKT_ERROR_FEED_MISSING, STEP_MOTION, 0.0);
}

bool emit_motion(struct program *p, struct move *m)
{
    if (!travel_check(p, m) || (m->kind != MOVE_RAPID && !set_feed(p, m))) {
        return false;
    }
    *emit_event(p, m->kind) = *m;
    p->modes.at = m->end;
    return true;
}
