#include "cutter_compensation/cutter_compensation.h"

#include "base/assert.h"
#include "base/maths.h"
#include "cutter_compensation/as_move.h"
#include "cutter_compensation/contour.h"
#include "cutter_compensation/corner.h"
#include "cutter_compensation/nose.h"
#include "program/travel.h"

#include <string.h>

/* Below this cosine no arc leads from the tool to the end of an entry arc. */
#define ENTRY_COSINE_MIN 1e-4

void takt_cutter_compensation_open(struct cutter_compensation *o,
                                   const struct program_config *config)
{
    memset(o, 0, sizeof(*o));
    o->sharp_corners = config->sharp_corners;
    o->wanted_at = config->start;
    o->at = config->start;
}

bool takt_cutter_compensation_warning(struct cutter_compensation *o, struct diagnostic *diagnostic)
{
    TAKT_ASSERT(o->warnings <= COMPENSATION_WARNINGS_MAX);
    if (o->warnings == 0) {
        return false;
    }
    takt_diagnostic_set(diagnostic, TAKT_ERROR_OFFSET_LEFT_OUT, o->warning[0].line, 0, "", 0,
                        o->warning[0].radius_mm);
    o->warnings--;
    for (unsigned i = 0; i < o->warnings; i++) {
        o->warning[i] = o->warning[i + 1];
    }
    return true;
}

/* Probing moves are not compensated: where one has come to rest, whatever follows begins. */
void takt_cutter_compensation_answer(struct cutter_compensation *o, struct program *p,
                                     const struct program_answer *answer)
{
    if (p->question == QUESTION_PROBE) {
        o->wanted_at = answer->rest_at;
        o->at = answer->rest_at;
    }
    takt_program_answer(p, answer);
}

static bool is_compensated(const struct move *m)
{
    return move_is_motion(m) && m->cutter_side != CUTTER_OFF;
}

static double left_of(const struct move *m)
{
    TAKT_ASSERT(m->cutter_radius_mm >= 0.0);
    return m->cutter_side == CUTTER_LEFT ? m->cutter_radius_mm : -m->cutter_radius_mm;
}

static bool fail(struct diagnostic *d, enum takt_error code, uint32_t line, double value)
{
    TAKT_ASSERT(code != TAKT_OK);
    takt_diagnostic_set(d, code, line, 0, "", 0, value);
    return false;
}

/*
 * An entry arc starts at the tool, C, and ends at A beside the programmed end, in its direction:
 * its centre is on the line from A towards the programmed centre, u, and as far from C as from A.
 *
 *     |A B| = |C - A|^2 / (2 (C - A) . u)
 */
static bool curve_entry(const struct cutter_compensation *o, struct compensation_piece *entry)
{
    struct planar *way = &entry->live.way;
    double c[2];

    takt_nose_centre(&o->pattern, entry->item.wanted.from, c);
    const double to_tool[2] = {c[0] - way->to[0], c[1] - way->to[1]};
    const double radius = takt_planar_between(way->centre, way->to);
    const double u[2] = {(way->centre[0] - way->to[0]) / radius,
                         (way->centre[1] - way->to[1]) / radius};
    const double towards = planar_dot(to_tool, u);
    const double distance = takt_planar_between(c, way->to);

    if (towards < ENTRY_COSINE_MIN * distance) {
        return false;
    }
    const double new_radius = 0.5 * distance * distance / towards;
    const double centre[2] = {way->to[0] + new_radius * u[0], way->to[1] + new_radius * u[1]};
    const double to[2] = {way->to[0], way->to[1]};

    takt_planar_set_arc(way, c, to, centre, way->sense, 1);
    return true;
}

static bool enter(struct cutter_compensation *o, struct compensation_piece *entry,
                  const struct planar *wanted, struct diagnostic *d)
{
    const double distance = takt_planar_between(wanted->from, wanted->to);
    const double lack_mm = o->pattern.cutter_radius_mm - distance;

    if (lack_mm >= 0.0) {
        return fail(d, TAKT_ERROR_OFFSET_ENTRY_SHORT, entry->item.line, lack_mm);
    }
    if (wanted->involute) {
        return fail(d, TAKT_ERROR_OFFSET_ENTRY_INVOLUTE, entry->item.line, 0.0);
    }
    if (wanted->arc && !curve_entry(o, entry)) {
        return fail(d, TAKT_ERROR_OFFSET_ENTRY_ARC, entry->item.line, 0.0);
    }
    entry->item.entry = true;
    o->started = true;
    o->broken = false;
    takt_contour_continue(o, entry);
    return true;
}

static bool turns_too_often(const struct planar *involute)
{
    return maths_max(involute->unrolled_from, involute->unrolled_to) >
           COMPENSATION_TURNS_MAX * MATHS_TWO_PI;
}

static bool take_way(struct cutter_compensation *o, struct compensation_piece *way,
                     const struct planar *wanted, struct diagnostic *d)
{
    const double left_mm = left_of(&o->pattern);
    double lack_mm;

    if (wanted->involute && turns_too_often(wanted)) {
        return fail(d, TAKT_ERROR_OFFSET_TURNS, way->item.line, COMPENSATION_TURNS_MAX);
    }
    if (!takt_planar_offset(wanted, left_mm, &way->live.way, &lack_mm)) {
        return fail(d, TAKT_ERROR_OFFSET_ARC_SMALL, way->item.line, lack_mm);
    }
    if (!o->started) {
        return enter(o, way, wanted, d);
    }
    takt_corner_turn(o, way, left_mm);
    return true;
}

/* A compensated motion as a way, but for the way of the tool's centre. */
static struct compensation_piece piece_of(const struct cutter_compensation *o, struct move *m)
{
    struct compensation_piece piece = {
        .item = {.line = m->line,
                 .turns = m->turns,
                 .kind = COMPENSATION_WAY,
                 .move = (uint8_t)m->kind,
                 .programmed = (uint8_t)m->kind,
                 .path = (uint8_t)m->path,
                 .overrides = (uint8_t)m->overrides,
                 .correction_off = m->correction_off,
                 .changes = m->changes & CHANGES_MASK,
                 .cutter_entry = m->cutter_entry,
                 .wanted = {.centre = {m->centre_mm[0], m->centre_mm[1]},
                            .base_mm = m->base_radius_mm}},
    };
    double from[AXIS_COUNT];
    double to[AXIS_COUNT];

    takt_contour_turned(m->plane, &o->wanted_at, from);
    takt_contour_turned(m->plane, &m->end, to);
    memcpy(piece.live.motion.pace, move_pace(m), MOVE_PACE_BYTES);
    memcpy(piece.item.wanted.from, from, sizeof(piece.item.wanted.from));
    memcpy(piece.item.wanted.to, to, sizeof(piece.item.wanted.to));
    for (unsigned i = 0; i < COMPENSATION_ACROSS; i++) {
        piece.live.motion.across[i] = to[i + 2];
        piece.item.across |= from[i + 2] != to[i + 2];
    }
    return piece;
}

/* A move that is no motion, or the contour's pattern. */
static void add_other(struct cutter_compensation *o, enum compensation_kind kind, struct move *m)
{
    struct compensation_item item = {
        .line = m->line, .kind = (uint8_t)kind, .move = (uint8_t)m->kind};

    memcpy(item.event, move_event(m), sizeof(item.event));
    takt_contour_add(o, &item);
}

/* A compensated motion that is no way. */
static void take_standing(struct cutter_compensation *o, struct move *m,
                          struct compensation_piece *piece)
{
    if (!o->started) {
        add_other(o, COMPENSATION_PASSING, m);
        return;
    }
    piece->item.kind = COMPENSATION_STANDING;
    piece->item.motion = piece->live.motion;
    takt_contour_add(o, &piece->item);
}

/* A compensated motion. */
static bool take_motion(struct cutter_compensation *o, struct move *m, struct diagnostic *d)
{
    struct compensation_piece piece = piece_of(o, m);
    struct planar wanted;

    if (!o->started) {
        o->pattern = *m;
        o->changes = m->changes;
    }
    if (!takt_contour_wanted(&piece.item, &wanted)) {
        take_standing(o, m, &piece);
    } else {
        if (!take_way(o, &piece, &wanted, d)) {
            return false;
        }
        o->last = wanted;
        o->last_way = piece.item;
    }
    o->wanted_at = m->end;
    return true;
}

/* What is left of a broken contour is read over. */
static bool is_dropped(struct cutter_compensation *o, const struct move *m)
{
    const bool dropped = o->broken && is_compensated(m) && !m->cutter_entry;

    if (dropped) {
        o->wanted_at = m->end;
    }
    o->broken = dropped || (o->broken && !move_is_motion(m));
    return dropped;
}

/*
 * No more comes to the contour. A gap that is still open then is a place the tool does not fit
 * into.
 */
static bool close_contour(struct cutter_compensation *o, struct diagnostic *d)
{
    o->closed = true;
    return !o->gap || fail(d, TAKT_ERROR_OFFSET_GOUGE, o->gouge_line, o->gouge_mm);
}

/* Whatever comes after another tool begins where that is: compensation is off by then. */
static bool settles(const struct move *m)
{
    return m->kind == MOVE_TOOL && (m->tool_change || m->tool_loaded);
}

static bool ends_contour(const struct cutter_compensation *o, const struct move *m)
{
    const bool leaves = move_is_motion(m) && (!is_compensated(m) || m->cutter_entry);

    return o->started && (leaves || settles(m) || m->kind == MOVE_END);
}

static bool take(struct cutter_compensation *o, struct move *m, struct diagnostic *d)
{
    if (is_dropped(o, m)) {
        return true;
    }
    if (ends_contour(o, m)) {
        o->waiting = *m;
        o->is_waiting = true;
        return close_contour(o, d);
    }
    if (is_compensated(m)) {
        return take_motion(o, m, d);
    }
    if (move_is_motion(m)) {
        o->pattern = *m;
        o->wanted_at = m->end;
        add_other(o, COMPENSATION_PASSING, m);
    } else {
        add_other(o, COMPENSATION_COMMAND, m);
    }
    return true;
}

/* The contour is forgotten, but not what comes after it. */
static void give_up(struct cutter_compensation *o)
{
    o->count = 0;
    o->ways = 0;
    o->started = false;
    o->gap = false;
    o->broken = true;
    o->closed = o->is_waiting || o->is_held;
}

/* The oldest item is as it will be. */
static bool is_ready(struct cutter_compensation *o)
{
    if (o->count == 0) {
        return false;
    }
    return takt_contour_item(o, 0)->kind < COMPENSATION_CORNER || o->closed ||
           o->ways > COMPENSATION_LOOK_AHEAD;
}

/* The travel of what has been compensated; the program has looked at everything else. */
static bool check_travel(const struct cutter_compensation *o, const struct program *p,
                         const struct move *m, struct diagnostic *d)
{
    struct travel_excess excess;

    if (takt_travel_holds(&p->config, &o->at, m, &excess)) {
        return true;
    }
    takt_travel_report(d, m->line, 0, &excess);
    return false;
}

static bool give_out(struct cutter_compensation *o, const struct program *p, struct move *move,
                     struct diagnostic *d)
{
    const struct compensation_item *i = takt_contour_item(o, 0);
    const bool checked = i->kind > COMPENSATION_PASSING ||
                         (i->kind == COMPENSATION_PASSING && is_compensated(&o->pattern));

    TAKT_ASSERT(o->count > 0);
    takt_compensation_as_move(o, i, move);
    takt_contour_drop_first(o);
    o->changes = move->changes;
    if (checked && !check_travel(o, p, move, d)) {
        return false;
    }
    if (move_is_motion(move)) {
        o->at = move->end;
    }
    return true;
}

/* After the last of a contour: goes on with what has been put off. */
static bool go_on(struct cutter_compensation *o, struct program *p, struct diagnostic *d)
{
    o->closed = false;
    o->started = false;
    if (o->is_waiting) {
        o->is_waiting = false;
        if (settles(&o->waiting)) {
            o->wanted_at = o->at;
            takt_program_settle(p, &o->at);
        }
        return take(o, &o->waiting, d);
    }
    if (o->is_held) {
        o->is_held = false;
        o->broken = true;
        *d = o->held;
        return false;
    }
    return true;
}

/* An error of the program comes after everything before it. */
static bool put_off(struct cutter_compensation *o, const struct diagnostic *error)
{
    if (o->gap) {
        give_up(o);
    }
    o->held = *error;
    o->is_held = true;
    o->closed = true;
    return true;
}

static bool has_room(const struct cutter_compensation *o, struct diagnostic *d)
{
    if (o->count + COMPENSATION_ITEMS_ADDED <= COMPENSATION_ITEMS_MAX) {
        return true;
    }
    if (o->gap) {
        return fail(d, TAKT_ERROR_OFFSET_GOUGE, o->gouge_line, o->gouge_mm);
    }
    return fail(d, TAKT_ERROR_OFFSET_CROWDED, o->item[o->first].line,
                COMPENSATION_ITEMS_MAX - COMPENSATION_LOOK_AHEAD - COMPENSATION_ITEMS_ADDED);
}

/* The program waits until everything before it has been done: a contour, off by now, ends here. */
static enum program_result before_wait(struct cutter_compensation *o, struct diagnostic *d)
{
    if (o->count == 0) {
        return PROGRAM_WAIT;
    }
    return close_contour(o, d) ? PROGRAM_MOVE : PROGRAM_ERROR;
}

/* Reads one more move. PROGRAM_MOVE: it has been taken. */
static enum program_result read_on(struct cutter_compensation *o, struct program *p,
                                   struct diagnostic *d)
{
    struct move m;

    if (!has_room(o, d)) {
        return PROGRAM_ERROR;
    }
    switch (takt_program_next(p, &m, d)) {
    case PROGRAM_MOVE:
        return take(o, &m, d) ? PROGRAM_MOVE : PROGRAM_ERROR;
    case PROGRAM_ERROR:
        (void)put_off(o, d);
        return PROGRAM_MOVE;
    case PROGRAM_WAIT:
        return before_wait(o, d);
    case PROGRAM_LATER:
        return PROGRAM_LATER;
    case PROGRAM_END:
        break;
    }
    return PROGRAM_END;
}

/*
 * Nothing is kept back: what is not compensated goes through. PROGRAM_MOVE and *taken: it does not.
 */
static enum program_result pass_through(struct cutter_compensation *o, struct program *p,
                                        struct move *move, struct diagnostic *d, bool *taken)
{
    const enum program_result result = takt_program_next(p, move, d);

    if (result != PROGRAM_MOVE) {
        return result;
    }
    if (is_compensated(move)) {
        *taken = true;
        return take(o, move, d) ? PROGRAM_MOVE : PROGRAM_ERROR;
    }
    if (move_is_motion(move)) {
        o->broken = false;
        o->wanted_at = move->end;
        o->at = move->end;
    }
    return PROGRAM_MOVE;
}

enum program_result takt_cutter_compensation_next(struct cutter_compensation *o, struct program *p,
                                                  struct move *move, struct diagnostic *diagnostic)
{
    enum program_result result = PROGRAM_MOVE;
    bool taken = false;

    if (o->count == 0 && !o->started && !o->closed) {
        result = pass_through(o, p, move, diagnostic, &taken);
        if (!taken) {
            return result;
        }
    }
    while (result == PROGRAM_MOVE && !is_ready(o)) {
        if (o->closed) {
            result = go_on(o, p, diagnostic) ? PROGRAM_MOVE : PROGRAM_ERROR;
        } else {
            result = read_on(o, p, diagnostic);
        }
    }
    if (result == PROGRAM_MOVE && !give_out(o, p, move, diagnostic)) {
        result = PROGRAM_ERROR;
    }
    if (result == PROGRAM_ERROR) {
        give_up(o);
    }
    return result;
}
