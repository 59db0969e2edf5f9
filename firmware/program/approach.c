#include "program/approach.h"

#include "base/assert.h"
#include "base/maths.h"
#include "program/contour.h"
#include "program/coordinates.h"
#include "program/emit.h"
#include "program/events.h"
#include "program/flow.h"
#include "program/travel.h"

#define SECONDS_PER_MINUTE 60.0

void takt_approach_open(struct program *p)
{
    p->approach.pending = p->config.from_line > 0;
    p->approach.holds_line = p->approach.is_up = false;
    p->approach.setups = 0;
    p->approach.at = p->config.start;
    p->approach.height_mm = p->config.start.at[AXIS_Z];
}

/*
 * No curve goes further up than this: from its end, or from its centre by the distance of its
 * farther end.
 */
static double highest(const struct move *m, const struct point *start)
{
    enum axis axis[2];

    takt_plane_axes(m->plane, &axis[0], &axis[1]);
    if (!(move_is_arc(m) || move_is_involute(m)) || (axis[0] != AXIS_Z && axis[1] != AXIS_Z)) {
        return m->end.at[AXIS_Z];
    }
    double farthest = 0.0;

    for (unsigned i = 0; i < 2; i++) {
        const struct point *p = i == 0 ? start : &m->end;
        const double x = p->at[axis[0]] - m->centre_mm[0];
        const double y = p->at[axis[1]] - m->centre_mm[1];

        farthest = maths_max(farthest, maths_sqrt(x * x + y * y));
    }
    return m->centre_mm[axis[0] == AXIS_Z ? 0 : 1] + farthest;
}

static bool has_z(const struct program *p)
{
    return (p->config.axes & (1U << AXIS_Z)) != 0;
}

/* Nobody can start there. */
static bool give_up(struct program *p, enum takt_error code, uint32_t line)
{
    TAKT_ASSERT(code != TAKT_OK);
    p->approach.pending = false;
    p->phase = PROGRAM_ENDED;
    p->queue_count = 0;
    takt_diagnostic_set(&p->error, code, line, 0, "", 0, p->config.from_line);
    return false;
}

bool takt_approach_drop(struct program *p)
{
    struct program_approach *a = &p->approach;
    struct move m;

    while (takt_emit_take(p, &m)) {
        if (m.kind == MOVE_PROBE) {
            return give_up(p, TAKT_ERROR_FROM_LINE_PROBE, m.line);
        }
        if (m.kind == MOVE_SETUP) {
            a->setup[m.channel] = m.setup;
            a->setups |= (uint8_t)(1U << m.channel);
        }
        if (move_is_motion(&m)) {
            a->height_mm = maths_max(a->height_mm, highest(&m, &a->at));
            a->at = m.end;
        }
    }
    if (p->phase != PROGRAM_ENDED) {
        return true;
    }
    return give_up(p, TAKT_ERROR_FROM_LINE_MISSED, 0);
}

/* Exactly, and to rest at the end. */
static void go(struct program *p, enum move_kind kind, struct point *at, const struct point *end)
{
    if (point_is_same(at, end)) {
        return;
    }
    struct move *m = takt_emit_event(p, kind);

    m->end = *end;
    m->path = PATH_EXACT_STOP;
    *at = *end;
}

static void bring_tool(struct program *p)
{
    const struct program_modes *m = &p->modes;

    if (m->tool_current != 0) {
        takt_emit_event(p, MOVE_TOOL)->tool = m->tool_current;
        struct move *change = takt_emit_event(p, MOVE_TOOL);

        change->tool = m->tool_current;
        change->tool_change = true;
    }
    if (m->tool_is_selected && m->tool_selected != m->tool_current) {
        takt_emit_event(p, MOVE_TOOL)->tool = m->tool_selected;
    }
}

static double feed_down(const struct program *p)
{
    return p->modes.feed_mm_s > 0.0 ? p->modes.feed_mm_s
                                    : PROGRAM_APPROACH_FEED_MM_MIN / SECONDS_PER_MINUTE;
}

static void set_up_part(struct program *p)
{
    struct move *last = NULL;

    for (unsigned i = 0; i < MOVE_SETUP_VALUES; i++) {
        if ((p->approach.setups & 1U << i) != 0) {
            last = takt_emit_event(p, MOVE_SETUP);
            last->channel = i;
            last->setup = p->approach.setup[i];
        }
    }
    if (last != NULL) {
        last->setup_ends = true;
    }
}

/* In two halves: the queue has no room for all of it. */
static void queue_way_up(struct program *p)
{
    struct program_approach *a = &p->approach;
    struct point next = p->config.start;

    if (has_z(p)) {
        next.at[AXIS_Z] = maths_min(a->height_mm, p->config.travel_max[AXIS_Z]);
    }
    a->at = p->config.start;
    go(p, MOVE_RAPID, &a->at, &next);
    bring_tool(p);
    set_up_part(p);
    a->holds_line = a->is_up = true;
}

static void queue_way_there(struct program *p)
{
    struct point *at = &p->approach.at;
    struct point next = p->modes.at;

    next.at[AXIS_Z] = at->at[AXIS_Z];
    go(p, MOVE_RAPID, at, &next);
    if (p->modes.direction != SPINDLE_OFF) {
        takt_events_tell_spindle(p);
    }
    if (p->modes.mist || p->modes.flood) {
        takt_events_tell_coolant(p);
    }
    const unsigned before = p->queue_count;

    go(p, MOVE_FEED, at, &p->modes.at);
    if (p->queue_count > before) {
        p->queue[(p->queue_first + before) % PROGRAM_QUEUE_MAX].feed_mm_s = feed_down(p);
    }
}

/* Behind a compensated contour the programmed place may be out of the travel. */
static bool is_within_travel(struct program *p)
{
    struct move m;
    struct travel_excess excess;

    takt_emit_prepare(p, MOVE_RAPID, &p->modes.at, &m);
    if (takt_travel_holds(&p->config, &p->config.start, &m, &excess)) {
        return true;
    }
    (void)give_up(p, TAKT_ERROR_TRAVEL_EXCEEDED, p->lexer.line);
    takt_travel_report(&p->error, p->lexer.line, 0, &excess);
    return false;
}

bool takt_approach_begins(struct program *p, bool *good)
{
    if (!p->approach.pending || p->lexer.line != p->config.from_line || flow_is_skipping(p) ||
        contour_is_open(p)) {
        return false;
    }
    p->approach.pending = false;
    *good = (p->modes.cutter_side == CUTTER_OFF ||
             give_up(p, TAKT_ERROR_FROM_LINE_CUTTER, p->lexer.line)) &&
            is_within_travel(p);
    if (*good) {
        queue_way_up(p);
    }
    return true;
}

bool takt_approach_goes_on(struct program *p)
{
    struct program_approach *a = &p->approach;

    a->holds_line = a->is_up;
    if (a->is_up) {
        a->is_up = false;
        queue_way_there(p);
    }
    return a->holds_line;
}
