/*
 * A canonical move: what a part program comes to once modes, offsets, units and expressions are
 * gone. Machine coordinates, mm and rad, mm/s. The one thing that leaves this room.
 */
#ifndef TAKT_PROGRAM_MOVE_H
#define TAKT_PROGRAM_MOVE_H

#include "base/point.h"
#include "geometry/curve.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum move_kind {
    /* motion */
    MOVE_RAPID,
    MOVE_FEED,
    MOVE_ARC_CW,
    MOVE_ARC_CCW,
    MOVE_INVOLUTE_CW,
    MOVE_INVOLUTE_CCW,
    MOVE_SPLINE,  /* a piece of a spline, told by its course */
    MOVE_THREAD,  /* a line whose feed follows the spindle: G33, G76 */
    MOVE_TAP,     /* the same into the hole; the spindle turns back at its end: G33.1 */
    MOVE_TAP_OUT, /* and back out, the spindle turning the other way; then as before again */
    MOVE_PROBE,   /* a line that ends early when the probe answers: G38 */
    /* in between: the axes stand while these happen */
    MOVE_DWELL,
    MOVE_SPINDLE,
    MOVE_ORIENT, /* the spindle stops at an angle */
    MOVE_COOLANT,
    MOVE_TOOL,
    MOVE_OUTPUT, /* a digital or analogue output changes: M62 to M65, M67, M68 */
    MOVE_INPUT,  /* waits for an input, or only reads it: M66 */
    MOVE_WEAR,   /* what a tool has cut since it was new is set: G10 L12 */
    MOVE_SETUP,  /* a number of the set-up of the part (correction/settings.h): G10 L13 */
    MOVE_STOP,
    MOVE_END
};

enum move_path { PATH_EXACT /* G61 */, PATH_EXACT_STOP /* G61.1 */, PATH_BLEND /* G64 */ };

enum spindle_direction { SPINDLE_OFF, SPINDLE_CW, SPINDLE_CCW };

/*
 * Which side of the programmed path the tool is on, looking along it, the plane seen from its third
 * axis.
 */
enum cutter_side { CUTTER_OFF, CUTTER_LEFT /* G41 */, CUTTER_RIGHT /* G42 */ };

/* Highest orientation of a lathe tool. */
#define CUTTER_ORIENTATION_MAX 9

/* The way the spindle turns to the angle of MOVE_ORIENT. */
enum orient_way { ORIENT_SHORTEST, ORIENT_CW, ORIENT_CCW };

/* What MOVE_INPUT waits for. */
enum input_wait { INPUT_READ, INPUT_RISE, INPUT_FALL, INPUT_HIGH, INPUT_LOW };

/* Numbers of the set-up of the part: displaced along X Y Z, turned about them, its table turned. */
#define MOVE_SETUP_VALUES (2 * AXIS_LINEAR_COUNT + 1)

/* Overrides a motion obeys: bits of struct move, overrides. */
#define OVERRIDE_FEED     1U /* M48, M50 P1 */
#define OVERRIDE_SPINDLE  2U /* M48, M51 P1 */
#define OVERRIDE_ADAPTIVE 4U /* M52 P1 */
#define OVERRIDE_HOLD     8U /* M53 P1: the operator may hold the feed */

/*
 * What a move of one kind alone has lies in one place, in unions: numbers only, so that reading one
 * that another kind has written is no more than a wrong number.
 */
struct move {
    enum move_kind kind;
    enum move_path path;
    enum plane plane; /* arcs, involutes and whatever is compensated */
    /*
     * Not CUTTER_OFF: end and centre are the programmed ones, the room offset moves them by the
     * radius
     */
    enum cutter_side cutter_side;
    uint32_t line;
    /* motion: MOVE_RAPID to MOVE_PROBE */
    struct point end;
    /* along the path; 0 for a rapid: as fast as the axes allow. rad/s when only A B C move */
    double feed_mm_s;
    double feed_rev_mm; /* not 0: the feed follows the spindle, so much (mm, or rad) per revolution;
                           feed_mm_s is what that comes to at the commanded speed */
    double tolerance_mm; /* PATH_BLEND: largest distance from the programmed path; 0: exact */
    double merge_mm;     /* PATH_BLEND: within this, short moves may become one (G64 Q) */
    union {
        double cutter_radius_mm; /* > 0 */
        double spline_mm;        /* splines, which are never compensated: length */
    };
    /* what position-error correction goes by */
    float work_mm[AXIS_LINEAR_COUNT];     /* zero of the part, machine coordinates */
    float overhang_mm[AXIS_LINEAR_COUNT]; /* tool offset */
    /*
     * from here on, beside kind and line, is all that what happens in between has: MOVE_EVENT_BYTES
     */
    union {
        struct {
            double centre_mm[2];   /* arcs, and the base circle of involutes: absolute, first and
                                    second axis of the plane */
            double base_radius_mm; /* involutes: of the base circle */
        };
        struct {
            double heading_rad[2], curvature_1_mm[2]; /* splines: at both ends */
        };
        double speed_ratio; /* MOVE_TAP_OUT: speed of the spindle relative to the way in, >= 1 */
        double dwell_s;     /* MOVE_DWELL */
        struct {
            double speed_rpm;    /* MOVE_SPINDLE; with surface_mm_s the highest, 0: any */
            double surface_mm_s; /* MOVE_SPINDLE: not 0: constant surface speed (G96) */
            double surface_x_mm; /* with surface_mm_s: machine X of the spindle's axis */
        };
        struct {
            double orient_rad; /* MOVE_ORIENT */
            double timeout_s;  /* MOVE_ORIENT, MOVE_INPUT: 0: none given */
        };
        struct {
            double wear_length_mm, wear_time_s; /* MOVE_WEAR */
        };
        double setup;  /* MOVE_SETUP: mm or rad */
        double output; /* MOVE_OUTPUT: 0 or 1; any value of an analogue one */
    };
    union {
        uint32_t turns; /* arcs: 1 = less than or exactly one turn */
        uint32_t
            channel; /* MOVE_OUTPUT, MOVE_INPUT: number of the output or input; MOVE_SETUP: which */
    };
    uint32_t tool;          /* MOVE_TOOL, MOVE_WEAR: number; motion: of the tool in the spindle */
    unsigned overrides;     /* motion: OVERRIDE_... */
    uint8_t correction_off; /* bit i set: the program has switched layer i off */
    uint8_t contour_side;   /* enum cutter_side the contour was programmed with */
    uint8_t
        cutter_orientation; /* 1 to 8: a lathe tool, led by a point beside its nose; in G18 alone */
    uint8_t changes;        /* of parameters, that come before it: their number (changes.h) */
    bool cutter_entry : 1;  /* nothing has moved in the plane yet since compensation is on */
    bool probe_away : 1;    /* MOVE_PROBE: ends when contact is lost (G38.4, G38.5), else made */
    bool probe_optional : 1; /* MOVE_PROBE: to reach the end is no error (G38.3, G38.5) */
    /* in between */
    bool mist : 1, flood : 1;         /* MOVE_COOLANT: state after it */
    bool tool_change : 1;             /* MOVE_TOOL: M6, else T alone (prepare) */
    bool tool_loaded : 1;             /* MOVE_TOOL: M61, it is in the spindle already */
    bool analogue : 1;                /* MOVE_OUTPUT, MOVE_INPUT */
    bool with_motion : 1;             /* MOVE_OUTPUT: M62, M63, M67 */
    bool optional : 1;                /* MOVE_STOP: M1 */
    bool setup_ends : 1;              /* MOVE_SETUP: the last number of its line */
    enum spindle_direction direction; /* MOVE_SPINDLE */
    enum orient_way orient_way;       /* MOVE_ORIENT */
    enum input_wait input_wait;       /* MOVE_INPUT */
};

/* What a move that is no motion has beside its kind and line: the members from centre_mm on. */
#define MOVE_EVENT_BYTES (sizeof(struct move) - offsetof(struct move, centre_mm))

/* Its feed, and how exactly it is to be gone: the members from feed_mm_s to merge_mm. */
#define MOVE_PACE_BYTES (offsetof(struct move, cutter_radius_mm) - offsetof(struct move, feed_mm_s))

static inline void *move_pace(struct move *m)
{
    return (unsigned char *)m + offsetof(struct move, feed_mm_s);
}

static inline void *move_event(struct move *m)
{
    return (unsigned char *)m + offsetof(struct move, centre_mm);
}

static inline bool move_is_motion(const struct move *m)
{
    return m->kind <= MOVE_PROBE;
}

static inline bool move_is_arc(const struct move *m)
{
    return m->kind == MOVE_ARC_CW || m->kind == MOVE_ARC_CCW;
}

static inline bool move_is_involute(const struct move *m)
{
    return m->kind == MOVE_INVOLUTE_CW || m->kind == MOVE_INVOLUTE_CCW;
}

/* No line between its ends? */
static inline bool move_is_curved(const struct move *m)
{
    return move_is_arc(m) || move_is_involute(m) || m->kind == MOVE_SPLINE;
}

/* Does its position follow the spindle's angle, and not only its feed the spindle's speed? */
static inline bool move_kind_is_synchronized(enum move_kind kind)
{
    return kind == MOVE_THREAD || kind == MOVE_TAP || kind == MOVE_TAP_OUT;
}

static inline bool move_is_synchronized(const struct move *m)
{
    return move_kind_is_synchronized(m->kind);
}

/* The geometry of a motion that starts at start. False when it has no length. */
bool takt_move_curve(const struct move *m, const struct point *start, struct curve *c);

#endif
