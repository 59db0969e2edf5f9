/*
 * Inside the compensation: public only so that the caller can own the memory. Read offset.h instead.
 */
#ifndef TAKT_OFFSET_STATE_H
#define TAKT_OFFSET_STATE_H

#include "base/error.h"
#include "offset/offset_limits.h"
#include "offset/planar.h"
#include "program/move.h"

enum offset_kind {
    OFFSET_COMMAND,  /* no motion */
    OFFSET_STANDING, /* motion of other axes than the plane's */
    OFFSET_CORNER,   /* way around an outer corner */
    OFFSET_WAY       /* a programmed move */
};

struct offset_item {
    /* As programmed. Of a corner, of the move behind it, but for what contour_wanted needs of the one before */
    struct move move;
    double wanted_from[2]; /* where the programmed way begins, of which move has the rest */
    struct planar way;     /* of the tool's centre in the plane */
    enum offset_kind kind;
    enum move_kind wanted; /* the kind of the programmed way */
    bool left_out;         /* swallowed by an inner corner; kept until its end is known */
    bool entry;            /* comes from outside the contour: starts where the tool is */
    bool across;           /* moves other axes too */
};

struct offset {
    bool sharp_corners;
    struct offset_item item[OFFSET_ITEMS_MAX]; /* ring */
    unsigned first, count;
    unsigned ways;       /* of kind corner or way, not left out */
    bool started;        /* a contour is being followed */
    bool gap;            /* an inner corner has begun and its end is not known */
    double gouge_mm;     /* gap: what the tool would cut away */
    uint32_t gouge_line; /* gap: of the move that began it */
    bool closed;         /* nothing is added to the contour any more */
    bool broken;         /* there was an error: what is left of the contour is dropped */
    bool is_waiting;     /* closed: a move comes after the contour */
    struct move waiting;
    bool is_held; /* closed: an error of the program comes after the contour */
    struct diagnostic held;
    struct point wanted_at; /* programmed end of the last motion */
    struct point at;        /* end of the last motion given out */
    struct planar last;     /* the contour's last way as programmed, */
    struct move last_move;  /* and its move */
    struct diagnostic warning[OFFSET_WARNINGS_MAX];
    unsigned warnings;
};

#endif
