#include "program/emit.h"

#include "base/assert.h"
#include "base/maths.h"
#include "program/coordinates.h"
#include "program/cutter.h"
#include "program/cycles.h"
#include "program/report.h"
#include "program/travel.h"
#include "program/words.h"

#include <string.h>

#define SECONDS_PER_MINUTE 60.0

/* Maximum for a surface speed without one: above that of any spindle. */
#define RPM_MAX 1e6

/*
 * What position-error correction goes by. The part's zero is the machine position of work
 * coordinate 0, without tool:
 *
 *     system + T (axis offset)
 */
static void describe(const struct program *p, struct move *m)
{
    struct point axis_offset = p->modes.axis_offset;

    takt_coordinates_turn(&p->modes.turn, &axis_offset.at[AXIS_X], &axis_offset.at[AXIS_Y]);
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        m->work_mm[i] = (float)(p->modes.system_offset.at[i] + axis_offset.at[i]);
        m->overhang_mm[i] = (float)p->modes.tool_offset.at[i];
    }
    m->correction_off = p->modes.correction_off;
}

struct move *takt_emit_event(struct program *p, enum move_kind kind)
{
    TAKT_ASSERT(p->queue_count < PROGRAM_QUEUE_MAX);
    struct move *m = &p->queue[(p->queue_first + p->queue_count++) % PROGRAM_QUEUE_MAX];

    memset(m, 0, sizeof(*m));
    m->kind = kind;
    m->line = p->lexer.line;
    return m;
}

bool takt_emit_take(struct program *p, struct move *move)
{
    TAKT_ASSERT(p->queue_count <= PROGRAM_QUEUE_MAX);
    if (takt_cycles_next(p, move)) {
        return true;
    }
    if (p->queue_count == 0) {
        return false;
    }
    *move = p->queue[p->queue_first];
    p->queue_first = (p->queue_first + 1) % PROGRAM_QUEUE_MAX;
    p->queue_count--;
    takt_cycles_count_queued(p);
    return true;
}

void takt_emit_prepare(const struct program *p, enum move_kind kind, const struct point *end,
                       struct move *m)
{
    memset(m, 0, sizeof(*m));
    m->kind = kind;
    m->line = p->lexer.line;
    m->end = *end;
    m->path = p->modes.path;
    m->overrides = p->modes.overrides;
    m->tool = p->modes.tool_current;
    describe(p, m);
    if (m->path == PATH_BLEND) {
        m->tolerance_mm = p->modes.tolerance_mm;
        m->merge_mm = p->modes.merge_mm;
    }
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
 * Inverse time: the move takes 1/F minutes, so feed = length F / 60. One without length gets any
 * feed that is not 0, since nobody runs it.
 */
static double inverse_time_feed(const struct program *p, const struct move *m)
{
    struct curve curve;
    const double rate_per_s = words_has(p, 'f') ? words_value(p, 'f') / SECONDS_PER_MINUTE : 0.0;

    return takt_move_curve(m, &p->modes.at, &curve) ? curve.length_mm * rate_per_s : rate_per_s;
}

/*
 * Constant surface speed v at the distance x of the tool from the spindle's axis:
 *
 *     speed = v / (2 pi |x|),   not above its maximum
 */
static double surface_rpm(const struct program *p)
{
    const double x_mm = maths_abs(takt_coordinates_work(p, AXIS_X)) * p->modes.unit_mm;
    const double max_rpm = p->modes.surface_max_rpm != 0.0 ? p->modes.surface_max_rpm : RPM_MAX;
    const double turn_mm = MATHS_TWO_PI * x_mm;
    const double mm_min = p->modes.surface_mm_s * SECONDS_PER_MINUTE;

    return mm_min < max_rpm * turn_mm ? mm_min / turn_mm : max_rpm;
}

/* The commanded speed; 0 when the spindle stands. */
static double spindle_rpm(const struct program *p)
{
    if (p->modes.direction == SPINDLE_OFF) {
        return 0.0;
    }
    return p->modes.surface_speed ? surface_rpm(p) : p->modes.speed_rpm;
}

/* feed = feed per revolution * speed. A position that follows the angle needs one. */
static bool follow_spindle(struct program *p, struct move *m)
{
    const struct program_span span = p->words.code_span[STEP_MOTION];
    const double rpm = spindle_rpm(p);

    if (!(rpm > 0.0)) {
        return takt_report_error(p, TAKT_ERROR_SPINDLE_STANDS, span, 0.0);
    }
    if (move_is_synchronized(m) && !p->config.spindle_encoder) {
        return takt_report_error(p, TAKT_ERROR_SPINDLE_NO_ENCODER, span, 0.0);
    }
    m->feed_mm_s = m->feed_rev_mm * rpm / SECONDS_PER_MINUTE;
    return true;
}

bool takt_emit_set_feed(struct program *p, struct move *m)
{
    TAKT_ASSERT(m->kind != MOVE_RAPID);
    if (p->modes.per_revolution && m->feed_rev_mm == 0.0) {
        m->feed_rev_mm = moves_rotary_only(p, m) ? p->modes.feed_rev_rad : p->modes.feed_rev_mm;
        m->feed_mm_s = m->feed_rev_mm;
    }
    if (m->feed_rev_mm != 0.0) {
        return follow_spindle(p, m);
    }
    if (p->modes.inverse_time) {
        m->feed_mm_s = inverse_time_feed(p, m);
    } else if (moves_rotary_only(p, m)) {
        m->feed_mm_s = p->modes.feed_rad_s;
    } else if (!p->modes.per_revolution) {
        m->feed_mm_s = p->modes.feed_mm_s;
    }
    return m->feed_mm_s > 0.0 ||
           takt_report_error_code(p, TAKT_ERROR_FEED_MISSING, STEP_MOTION, 0.0);
}

bool takt_emit_motion(struct program *p, struct move *m)
{
    TAKT_ASSERT(move_is_motion(m));
    takt_cutter_apply(p, m);
    m->contour_side = (uint8_t)m->cutter_side;
    if (!takt_travel_check(p, m) || (m->kind != MOVE_RAPID && !takt_emit_set_feed(p, m))) {
        return false;
    }
    *takt_emit_event(p, m->kind) = *m;
    p->modes.at = m->end;
    return true;
}
