#include "program/drilling.h"

#include "base/assert.h"
#include "program/coordinates.h"
#include "program/cycles.h"
#include "program/events.h"

#include <string.h>

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

    takt_coordinates_work_of(p, &p->modes.at, &work);
    for (unsigned i = 0; i < 2; i++) {
        work.at[c->axis[i]] = c->hole_mm[i] + (place == ASIDE ? c->aside_mm[i] : 0.0);
    }
    work.at[c->axis[2]] = height;
    return takt_cycles_move(p, kind, &work, move);
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
        return go(p, MOVE_RAPID, c->depth_mm + c->clearance_mm, HOLE, move);
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
    takt_events_spindle_move(p, direction, move);
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
                                    : &scripts[cycles_kind(c->code)][c->stage - APPROACH_ROWS];
}

/* One hole is done. */
static void next_hole(struct program_cycle *c)
{
    TAKT_ASSERT(c->repeats > 0);
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

bool takt_drilling_next(struct program *p, struct move *move)
{
    struct program_cycle *c = &p->cycle;

    TAKT_ASSERT(p->cycle.code != NULL);
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
