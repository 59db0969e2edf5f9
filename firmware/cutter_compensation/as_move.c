/* An item of a contour as the move that it is given out as. */
#include "cutter_compensation/as_move.h"

#include "base/assert.h"
#include "base/maths.h"
#include "cutter_compensation/contour.h"
#include "cutter_compensation/nose.h"

#include <string.h>

/* An arc shorter than this might be taken for a full circle: it is gone as a line. */
#define ARC_MIN_MM 1e-6
/* Start and end of an arc closer than this are one point (as in the room geometry). */
#define ARC_CLOSED_MM 1e-7

/* Turns begun: takt_curve_set_arc adds one turn less than these to the angle from start to end. */
static uint32_t turns_of(const struct planar *way)
{
    const double whole = takt_maths_round(way->sweep_rad / MATHS_TWO_PI);
    const double rest_mm = maths_abs(way->sweep_rad - whole * MATHS_TWO_PI) * way->radius_to;

    if (whole >= 1.0 && rest_mm <= ARC_CLOSED_MM) {
        return (uint32_t)whole;
    }
    return (uint32_t)takt_maths_floor(way->sweep_rad / MATHS_TWO_PI) + 1;
}

static void set_arc(struct move *m, const struct planar *way, const double lead_mm[2])
{
    TAKT_ASSERT(way->arc);
    if (takt_planar_length(way) < ARC_MIN_MM) {
        m->kind = MOVE_FEED;
        return;
    }
    m->centre_mm[0] = way->centre[0] + lead_mm[0];
    m->centre_mm[1] = way->centre[1] + lead_mm[1];
    m->turns = turns_of(way);
}

static void set_involute(struct move *m, const struct planar *way, const double lead_mm[2])
{
    TAKT_ASSERT(way->involute);
    if (takt_planar_length(way) < ARC_MIN_MM) {
        m->kind = MOVE_FEED;
        return;
    }
    m->centre_mm[0] = way->centre[0] + lead_mm[0];
    m->centre_mm[1] = way->centre[1] + lead_mm[1];
    m->base_radius_mm = way->base_mm;
}

/*
 * The motion of a contour's item, the tool's centre, or the point that a lathe tool is led by,
 * going its way.
 */
static void finish_motion(struct cutter_compensation *o, const struct compensation_item *i,
                          struct move *m)
{
    const struct compensation_live *live = takt_contour_live(o, i);
    const bool stands = i->kind == COMPENSATION_STANDING;
    const struct compensation_motion *motion = stands ? &i->motion : &live->motion;
    double lead_mm[2];
    double end[AXIS_COUNT];

    TAKT_ASSERT(i->kind >= COMPENSATION_STANDING);
    m->kind = (enum move_kind)i->move;
    m->path = (enum move_path)i->path;
    m->line = i->line;
    m->changes = (uint8_t)(o->changes + ((i->changes - o->changes) & CHANGES_MASK));
    memcpy(move_pace(m), motion->pace, MOVE_PACE_BYTES);
    m->overrides = i->overrides;
    m->correction_off = i->correction_off;
    m->cutter_entry = i->cutter_entry;
    takt_nose_lead(m, lead_mm);
    takt_contour_turned(m->plane, &o->at, end);
    if (!stands) {
        end[0] = live->way.to[0] + lead_mm[0];
        end[1] = live->way.to[1] + lead_mm[1];
    }
    memcpy(&end[2], motion->across, sizeof(motion->across));
    takt_contour_point(m->plane, end, &m->end);
    if (stands) {
        m->kind = move_is_involute(m) ? MOVE_FEED : m->kind;
    } else if (move_is_arc(m)) {
        set_arc(m, &live->way, lead_mm);
    } else if (move_is_involute(m)) {
        set_involute(m, &live->way, lead_mm);
    }
}

void takt_compensation_as_move(struct cutter_compensation *o, const struct compensation_item *i,
                               struct move *m)
{
    if (i->kind == COMPENSATION_COMMAND) {
        memset(m, 0, sizeof(*m));
        m->kind = (enum move_kind)i->move;
        m->line = i->line;
        memcpy(move_event(m), i->event, sizeof(i->event));
        return;
    }
    *m = o->pattern;
    m->cutter_side = CUTTER_OFF;
    if (i->kind != COMPENSATION_PASSING) {
        finish_motion(o, i, m);
    }
}
