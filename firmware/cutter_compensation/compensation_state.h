/*
 * Inside the compensation: public only so that the caller can own the memory. Read offset.h
 * instead.
 */
#ifndef TAKT_CUTTER_COMPENSATION_STATE_H
#define TAKT_CUTTER_COMPENSATION_STATE_H

#include "base/error.h"
#include "cutter_compensation/compensation_limits.h"
#include "cutter_compensation/planar.h"
#include "program/move.h"

#include <stdint.h>

enum compensation_kind {
    COMPENSATION_COMMAND, /* no motion */
    /* a motion outside of any contour; it is alone, and struct cutter_compensation, pattern */
    COMPENSATION_PASSING,
    COMPENSATION_STANDING, /* motion of other axes than the plane's */
    COMPENSATION_CORNER,   /* way around an outer corner */
    COMPENSATION_WAY       /* a programmed move */
};

/* The axes that are not the plane's. */
#define COMPENSATION_ACROSS (AXIS_COUNT - 2)

/* A way as programmed, in its plane; kind and turns are beside it. */
struct compensation_wanted {
    double from[2], to[2];
    double centre[2]; /* arcs, involutes */
    double base_mm;   /* involutes */
};

/* What a motion has of its own, beside its way. All else its contour has in common. */
struct compensation_motion {
    /* ends of the axes that are not the plane's; the first is a linear one */
    double across[COMPENSATION_ACROSS];
    unsigned char pace[MOVE_PACE_BYTES];
};

/* Of the number of changes in an item: there are never so many between two motions of a contour. */
#define CHANGES_MASK 15U

/* A move, in as few bytes as there is no other way to have them back. */
struct compensation_item {
    uint32_t line;
    uint32_t turns; /* of the programmed way */
    uint8_t kind;   /* enum compensation_kind */
    uint8_t move; /* enum move_kind it is given out as; a way or a corner may still become a line */
    uint8_t programmed; /* enum move_kind of the programmed way */
    uint8_t path;       /* enum move_path */
    uint8_t overrides;  /* of struct move, as the next */
    uint8_t correction_off;
    /* corners and ways that are not left out: where in struct cutter_compensation the rest is */
    uint8_t live;
    bool cutter_entry : 1; /* of struct move */
    bool left_out : 1;     /* swallowed by an inner corner; kept until its end is known */
    bool entry : 1;        /* comes from outside the contour: starts where the tool is */
    bool across : 1;       /* moves other axes too */
    uint8_t changes : 4;   /* of struct move, the lower half; ways and standing motions */
    union {
        struct compensation_wanted wanted;     /* of a way; of a corner, of the way before it */
        struct compensation_motion motion;     /* COMPENSATION_STANDING */
        unsigned char event[MOVE_EVENT_BYTES]; /* COMPENSATION_COMMAND: of its move */
    };
};

/* The rest of what is still on the contour. */
struct compensation_live {
    struct planar way; /* of the tool's centre in the plane */
    struct compensation_motion motion;
};

/* One that is being made. */
struct compensation_piece {
    struct compensation_item item;
    struct compensation_live live;
};

/* A way that has been left out, for a warning. */
struct compensation_left_out {
    uint32_t line;
    double radius_mm;
};

struct cutter_compensation {
    bool sharp_corners;
    struct compensation_item item[COMPENSATION_ITEMS_MAX]; /* ring */
    unsigned first, count;
    /* ring: of corners and ways that are not left out, in their order */
    struct compensation_live live[COMPENSATION_WAYS_MAX];
    unsigned live_first, ways;
    bool started;        /* a contour is being followed */
    bool gap;            /* an inner corner has begun and its end is not known */
    double gouge_mm;     /* gap: what the tool would cut away */
    uint32_t gouge_line; /* gap: of the move that began it */
    uint8_t changes;     /* of struct move, given out last, or of the contour's first motion */
    bool closed;         /* nothing is added to the contour any more */
    bool broken;         /* there was an error: what is left of the contour is dropped */
    bool is_waiting;     /* closed: a move comes after the contour */
    struct move waiting;
    bool is_held; /* closed: an error of the program comes after the contour */
    struct diagnostic held;
    struct point wanted_at; /* programmed end of the last motion */
    struct point at;        /* end of the last motion given out */
    struct move pattern;    /* the contour's first motion: what they all have in common */
    struct planar last;     /* the contour's last way as programmed, */
    struct compensation_item last_way; /* and its item */
    struct compensation_left_out warning[COMPENSATION_WARNINGS_MAX];
    unsigned warnings;
};

#endif
