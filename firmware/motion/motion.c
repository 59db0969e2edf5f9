#include "motion/motion.h"

#include "base/assert.h"
#include "base/handoff.h"
#include "base/maths.h"
#include "motion/exchange.h"
#include "motion/held.h"
#include "plan/path_unit.h"
#include "plan/span.h"
#include "smooth/single.h"

#include <string.h>

/*
 * A setpoint this close to a junction that it lands on in motion is on it: rounding of the
 * trapezoidal reference's positions, path units.
 */
#define LANDED_UNITS 8.0

/* Waits without a cycle, and blocks, that one cycle passes at most. */
#define PASS_MAX 64

void takt_motion_init(struct motion *m, struct path *path, const struct point *start,
                      bool proportional)
{
    TAKT_ASSERT(path->limits.cycle_s > 0.0 && path->first == path->pushed);
    memset(m, 0, sizeof(*m));
    m->path = path;
    m->cycle_s = path->limits.cycle_s;
    m->at = *start;
    m->setpoint = path->position;
    takt_reference_init(&m->reference, path->limits.profile, path->position);
    takt_average_start(&m->mover.average, path->limits.profile, 1, path->position, 0);
    m->rested = 1;
    m->exchange = MOTION_CEILING_WANTED;
    m->request = (struct ceiling_request){.reference = m->reference.at,
                                          .span = m->reference.span,
                                          .cycles = 1,
                                          .feed_ratio = 1.0,
                                          .rapid_ratio = 1.0,
                                          .proportional = proportional};
}

/* -- stops, and what happens at them -- */

/* A change of the tool (M6), not its number alone. */
static bool waits_for_tool(const struct motion *m, enum move_kind kind, bool tool_waits)
{
    return kind == MOVE_TOOL && tool_waits && path_first(m->path)->move.tool_change;
}

static bool is_wait_over(const struct motion *m, enum move_kind kind)
{
    return kind != MOVE_DWELL ||
           (double)m->waited >=
               takt_maths_ceil(path_first(m->path)->move.dwell_s / m->cycle_s - 1e-9);
}

static bool is_handed_over(const struct motion *m, const struct block *b)
{
    if (move_is_synchronized(&b->move)) {
        return m->hands_over != MOTION_HANDS_OVER_NONE;
    }
    return b->move.kind != MOVE_PROBE &&
           (m->hands_over == MOTION_HANDS_OVER_ALL ||
            (m->hands_over == MOTION_HANDS_OVER_LINEAR && !takt_block_turns(b)));
}

/* M0, or M1 where the operator wants it. */
static bool is_program_stop(const struct motion *m, const struct motion_operator *wanted)
{
    struct move move;

    TAKT_ASSERT(m->path->first != m->path->pushed);
    if (wanted->obeys == MOTION_OBEYS_NONE || path_at(m->path, m->path->first)->motion ||
        takt_path_kind(m->path, m->path->first) != MOVE_STOP) {
        return false;
    }
    takt_path_read_move(m->path, m->path->first, &move);
    return !move.optional || wanted->obeys == MOTION_OBEYS_M0_AND_M1;
}

/* In a hold: is the oldest block none in which the axes can be held? It is left where it is. */
static bool is_kept(const struct motion *m, bool held)
{
    return held && (m->path->first == m->path->closed || !path_at(m->path, m->path->first)->motion);
}

static enum motion_result rest(struct motion *m)
{
    m->rested++;
    return MOTION_CYCLE;
}

/*
 * Goes through what happens at rest; of that only dwells and changes of the tool that wait are
 * read. MOTION_CYCLE: the axes move on in a block; NULL: they wait.
 */
static enum motion_result serve(struct motion *m, const struct motion_operator *wanted,
                                const struct block **block)
{
    bool held = wanted->hold != MOTION_GOES && m->end != MOTION_CHANGES_TOOL;

    *block = NULL;
    if (m->end == MOTION_ARRIVED && wanted->settles) {
        return rest(m);
    }
    if (m->end > MOTION_ARRIVED) {
        m->end = MOTION_UNDER_WAY;
    }
    for (unsigned passed = 0; passed < PASS_MAX; passed++) {
        if (m->end == MOTION_ARRIVED && !is_kept(m, held)) {
            m->end = is_program_stop(m, wanted) ? MOTION_STOPPED : MOTION_UNDER_WAY;
            takt_path_pass(m->path);
            held = wanted->hold != MOTION_GOES;
        }
        if (m->end == MOTION_STOPPED || is_kept(m, held)) {
            return rest(m);
        }
        if (m->path->first == m->path->closed) {
            return m->path->finished ? MOTION_EMPTY : MOTION_CYCLE;
        }
        m->current = m->path->first;
        if (path_at(m->path, m->current)->motion) {
            m->busy = m->busy || !ring_is_read(&m->path->ring, m->current);
            *block = path_first(m->path);
            return is_handed_over(m, *block) ? MOTION_HANDED_OVER : MOTION_CYCLE;
        }
        const enum move_kind kind = takt_path_kind(m->path, m->current);

        if (kind == MOVE_END) {
            return MOTION_DONE;
        }
        if (waits_for_tool(m, kind, wanted->tool_waits)) {
            m->end = MOTION_CHANGES_TOOL;
        }
        if (m->end == MOTION_CHANGES_TOOL || !is_wait_over(m, kind)) {
            m->waited++;
            return rest(m);
        }
        m->waited = 0;
        m->end = MOTION_ARRIVED;
    }
    return MOTION_CYCLE;
}

/* -- one setpoint -- */

/* Does the operator hold where the trapezoidal reference is? */
static bool is_held(const struct motion *m, const struct motion_operator *wanted)
{
    const struct reference_place *here = &m->reference.here;
    const bool stands =
        m->path->has_revolution_feed && wanted->measures && !(wanted->spindle_rev_s > 0.0);
    const unsigned holds = (wanted->hold != MOTION_GOES ? CEILING_HOLD : 0U) |
                           (wanted->feed_ratio > 0.0 ? 0U : CEILING_FEED) |
                           (wanted->rapid_ratio > 0.0 ? 0U : CEILING_RAPID) |
                           (stands ? CEILING_SPINDLE : 0U);

    if (m->ending || wanted->hold > MOTION_HOLD_ASKED) {
        return true;
    }
    if (holds == 0) {
        return false;
    }
    if (here->ceiling == NULL || here->piece >= here->ceiling->count) {
        return wanted->hold != MOTION_GOES;
    }
    return (takt_ceiling_overrides(here->ceiling, here->piece) & holds) != 0;
}

/*
 * The setpoint's distance from the start of its block and that one's length, path units, after
 * passing the blocks that it has left from b on: those are not read.
 */
static double find_block(struct motion *m, const struct block *b, double *length)
{
    uint64_t start = b->start;
    uint64_t end = start + b->length;
    double local = (double)(int64_t)(m->reference.at - start) - m->lag;

    *length = (double)b->length;
    for (unsigned passed = 0; local > *length; passed++) {
        if (passed == PASS_MAX || takt_span_stops(m->path, m->path->first) ||
            (local <= *length + LANDED_UNITS && takt_span_lands(m->path, m->path->first))) {
            break;
        }
        takt_path_pass(m->path);
        local -= *length;
        start = end;
        end = path_end(m->path, m->path->first);
        *length = (double)(end - start);
    }
    m->current = m->path->first;
    m->setpoint = start + (uint64_t)maths_max(0.0, local);
    return local;
}

/* Has the setpoint come to where the trapezoidal reference halts? */
static bool is_halted(const struct motion *m)
{
    return takt_reference_has_halted(&m->reference) && m->lag == 0.0;
}

static void place(struct motion *m, const struct block *b, double local, double length,
                  struct cycle_record *record)
{
    if (local == 0.0) {
        return;
    }
    if (maths_abs(local - length) <= LANDED_UNITS &&
        (local == length || takt_span_lands(m->path, m->path->first))) {
        const bool arrived = takt_span_stops(m->path, m->path->first) &&
                             reference_stands(&m->reference) && m->lag == 0.0;

        m->end = arrived ? MOTION_ARRIVED : MOTION_UNDER_WAY;
        m->rested = 0;
        record->landed =
            (arrived || is_halted(m) || takt_span_lands(m->path, m->current)) && !b->continues;
        m->at = b->curve.end;
        return;
    }
    const double s_mm = local / PATH_UNITS_PER_MM * b->scale;

    takt_curve_point(&b->curve, maths_clamp(s_mm, 0.0, b->curve.length_mm), &m->at);
}

/* Feed on the way from one setpoint to the next, of A, B, C where they are alone. */
static double feed_between(const struct motion *m, const struct block *b, const struct point *from)
{
    const int first = b->curve.rotary ? AXIS_LINEAR_COUNT : 0;
    const int end = b->curve.rotary ? AXIS_COUNT : AXIS_LINEAR_COUNT;
    float square = 0.0F;

    for (int i = first; i < end; i++) {
        const float way = (float)(m->at.at[i] - from->at[i]);

        square += way * way;
    }
    return (double)(single_sqrt(square) / (float)m->cycle_s);
}

/* The trapezoidal reference moves and its average with it. */
static void move_reference(struct motion *m, bool hold)
{
    if (takt_held_move(m, hold)) {
        return;
    }
    struct reference_start start = {.at = m->reference.at};
    double lag = m->lag;

    if (takt_reference_step(&m->reference, m->setpoint, hold, &start)) {
        takt_average_start(&m->mover.average, m->path->limits.profile, m->reference.cycles,
                           start.at, start.step);
        lag = average_lag(&m->mover.average);
        m->busy = true;
    }
    takt_average_push(&m->mover.average, m->reference.at);
    m->lag = average_lag(&m->mover.average);
    m->feed = path_mm(start.at, m->reference.at) - (m->lag - lag) / PATH_UNITS_PER_MM;
}

/*
 * May the stop be left? Not in the cycle that has passed something there: what an event asks to be
 * waited for is known only after it.
 */
static bool may_leave(const struct motion *m, const struct motion_operator *wanted)
{
    return reference_stands(&m->reference) && m->reference.at == path_first(m->path)->start &&
           m->rested > 0 && m->passed_first == m->path->first && !wanted->wait;
}

/*
 * The trapezoidal reference, its average, the path there, from block b on. Returns the block it
 * leads to.
 */
static const struct block *move_on(struct motion *m, const struct motion_operator *wanted,
                                   const struct block *b, struct cycle_record *record)
{
    struct point before;
    double length;

    if (may_leave(m, wanted)) {
        takt_reference_release(&m->reference);
    }
    if (is_halted(m)) {
        takt_reference_leave_halt(&m->reference);
    }
    if (reference_seeks(&m->reference) != wanted->single_block) {
        takt_reference_end_blocks(&m->reference, wanted->single_block);
    }
    m->rested++;
    move_reference(m, is_held(m, wanted));

    const double local = find_block(m, b, &length);

    if (m->current != m->passed_first) {
        b = path_first(m->path);
    }
    const bool smooth = b->curve.kind == CURVE_SPLINE; /* its path is nominal time */

    if (smooth) {
        before = m->at;
    }
    place(m, b, local, length, record);
    record->feed_mm_s = smooth ? feed_between(m, b, &before) : m->feed / m->cycle_s * b->scale;
    return b;
}

/* The axis velocity limiter: what an override above 100 % is cut down to. */
static double limiter_of(const struct motion *m, const struct block *b)
{
    if (b->move.kind == MOVE_RAPID || m->request.feed_ratio <= 1.0) {
        return 1.0;
    }
    return maths_min(1.0, b->feed_cap_mm_s / (b->feed_program_mm_s * m->request.feed_ratio));
}

/*
 * In a cycle that has little else to do. Where it has stalled the axes come to rest, and that is
 * the end.
 */
static void watch(struct motion *m, const struct motion_operator *wanted, const struct block *b)
{
    if (m->busy || m->cycles % WATCH_EVERY_CYCLES != WATCH_EVERY_CYCLES - 1) {
        return;
    }
    m->busy = true;
    if (!takt_watch_look(m, !is_held(m, wanted) && !wanted->wait)) {
        m->watch.line = b->move.line;
        m->ending = true;
    }
}

uint32_t takt_motion_stalled_line(const struct motion *m)
{
    return m->watch.line;
}

/* At rest: what is left of the path is dropped; false: it has stalled, and nothing follows. */
static bool end_path(struct motion *m)
{
    if (m->reference.feed > 0.0 || m->lag != 0.0) {
        return true;
    }
    if (m->watch.line != 0) {
        return m->feed != 0.0;
    }
    if (m->held == MOTION_HELD) {
        takt_held_end(m);
    }
    takt_path_restart(m->path, &m->at, m->reference.at);
    takt_reference_init(&m->reference, m->path->limits.profile, m->reference.at);
    m->setpoint = m->reference.at;
    m->rested = 0;
    m->end = m->end == MOTION_ARRIVED ? MOTION_UNDER_WAY : m->end;
    m->ending = false;
    handoff_set_count(&m->restarts, m->restarts + 1);
    TAKT_ASSERT(m->path->first == m->path->pushed);
    return true;
}

void takt_motion_end_here(struct motion *m)
{
    m->ending = true;
}

bool takt_motion_rests(const struct motion *m)
{
    return m->end == MOTION_ARRIVED || m->feed == 0.0 || is_halted(m);
}

bool takt_motion_is_idle(const struct motion *m)
{
    return m->path->first == m->path->pushed && !m->ending;
}

static void fill_record(struct motion *m, const struct block *b, struct cycle_record *record)
{
    record->cycle = m->cycles;
    record->block = b->number;
    record->line = b->move.line;
    record->override_percent = 100.0 * m->request.feed_ratio;
    record->limiter = block_is_motion(b) ? limiter_of(m, b) : 1.0;
    record->cmd = m->at;
    m->cycles++;
}

/*
 * A part of the block behind, in a cycle that has little else to do: the one that comes to it need
 * not read it. Not while a hold keeps what follows the motion that has ended: it would take that
 * one's place.
 */
static void read_ahead(struct motion *m)
{
    const uint32_t next = m->current + 1;

    if (!m->busy && m->passed_first == m->current && (int32_t)(m->path->closed - next) > 0) {
        path_prepare(m->path, next);
    }
}

enum motion_result takt_motion_cycle(struct motion *m, const struct motion_operator *wanted,
                                     struct cycle_record *record)
{
    const struct block *b;

    m->passed_first = m->path->first;
    if (!motion_has_ceiling(m) && m->exchange != MOTION_CEILING_BUILT) {
        return MOTION_NOT_YET;
    }
    m->busy = false;
    takt_motion_exchange(m, wanted);
    const enum motion_result result = serve(m, wanted, &b);

    if (result != MOTION_CYCLE) {
        return result;
    }
    record->landed = false;
    record->feed_mm_s = 0.0;
    m->feed_before[1] = m->feed_before[0];
    m->feed_before[0] = m->feed;
    m->feed = 0.0;
    if (b != NULL) {
        b = move_on(m, wanted, b, record);
        watch(m, wanted, b);
    } else {
        b = motion_block(m);
    }
    if (m->ending && !end_path(m)) {
        return MOTION_STALLED;
    }
    read_ahead(m);
    fill_record(m, b, record);
    return MOTION_CYCLE;
}
