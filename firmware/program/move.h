/*
 * A canonical move: what a part program comes to once modes, offsets, units and expressions are gone.
 * Machine coordinates, mm and rad, mm/s. The one thing that leaves this room.
 */
#ifndef TAKT_PROGRAM_MOVE_H
#define TAKT_PROGRAM_MOVE_H

#include "base/point.h"
#include "geometry/curve.h"

#include <stdbool.h>
#include <stdint.h>

enum move_kind {
    /* motion */
    MOVE_RAPID,
    MOVE_FEED,
    MOVE_ARC_CW,
    MOVE_ARC_CCW,
    /* in between: the axes stand while these happen */
    MOVE_DWELL,
    MOVE_SPINDLE,
    MOVE_COOLANT,
    MOVE_TOOL,
    MOVE_STOP,
    MOVE_END
};

enum move_path { PATH_EXACT /* G61 */, PATH_EXACT_STOP /* G61.1 */, PATH_BLEND /* G64 */ };

enum spindle_direction { SPINDLE_OFF, SPINDLE_CW, SPINDLE_CCW };

struct move {
    enum move_kind kind;
    uint32_t line;
    /* motion: MOVE_RAPID to MOVE_ARC_CCW */
    struct point end;
    double
        feed_mm_s; /* along the path; 0 for a rapid: as fast as the axes allow. rad/s when only A B C move */
    enum move_path path;
    double tolerance_mm; /* PATH_BLEND: largest distance from the programmed path; 0: exact */
    enum plane plane;    /* arcs */
    double centre_mm[2]; /* arcs: absolute, first and second axis of the plane */
    uint32_t turns;      /* arcs: 1 = less than or exactly one turn */
    /* in between */
    double dwell_s;                   /* MOVE_DWELL */
    enum spindle_direction direction; /* MOVE_SPINDLE */
    double speed_rpm;                 /* MOVE_SPINDLE */
    bool mist, flood;                 /* MOVE_COOLANT: state after it */
    uint32_t tool;                    /* MOVE_TOOL: number */
    bool tool_change;                 /* MOVE_TOOL: M6, else T alone (prepare) */
    bool optional;                    /* MOVE_STOP: M1 */
};

static inline bool move_is_motion(const struct move *m)
{
    return m->kind <= MOVE_ARC_CCW;
}

/* The geometry of a motion that starts at start. False when it has no length. */
bool move_curve(const struct move *m, const struct point *start, struct curve *c);

#endif
