/*
 * A planned block, ready to be executed: curve and feed profile, or a wait. What this room hands to motion.
 */
#ifndef TAKT_PLAN_SEGMENT_H
#define TAKT_PLAN_SEGMENT_H

#include "geometry/curve.h"
#include "plan/profile.h"
#include "program/move.h"

#include <stdbool.h>
#include <stdint.h>

/* The limit that governs the cruise feed of a block. */
enum governor {
    GOVERNOR_PROGRAM,      /* the programmed feed */
    GOVERNOR_VELOCITY,     /* an axis's maximum velocity */
    GOVERNOR_ACCELERATION, /* centripetal acceleration on an arc */
    GOVERNOR_JERK,         /* jerk on an arc */
    GOVERNOR_CHORD,        /* chord error on an arc */
    GOVERNOR_SHORT,        /* block of about one cycle: changes of direction must not pile up */
    GOVERNOR_RAMP          /* the block is too short to reach its feed */
};

/* What limits the feed at the end of a block. */
enum joint_kind {
    JOINT_PASSED,  /* full feed: the end is inside a span */
    JOINT_REDUCED, /* the change of direction or curvature needs a lower feed: landed */
    JOINT_STOP     /* rest: landed */
};

struct segment {
    struct move move; /* the canonical move it came from */
    uint32_t block;   /* counts motions from 1; a wait has the number of the motion before it */
    enum joint_kind end;
    enum governor governor;
    /*
     * Control cycles that end inside the segment: cycle i (from 0) is first_s + i * cycle after its start. A landed
     * segment ends with a cycle at its very end; a short one that is passed may have none. For anything but motion:
     * cycles to rest, 0 for a mere event such as a spindle command (1 for each that follows WINDOW_INSTANT_MAX others).
     */
    uint64_t cycles;
    double first_s;
    /* motion alone */
    struct curve curve;
    struct profile profile;
};

#endif
