/*
 * A block: a stretch of one curve, and the limits of the feed along it.
 *
 * Everything here is found once, when the block and its neighbours are known; what the operator
 * does later (override) is applied where ceilings are made of blocks (ceiling.h).
 */
#ifndef TAKT_PLAN_BLOCK_H
#define TAKT_PLAN_BLOCK_H

#include "geometry/curve.h"
#include "plan/limits.h"
#include "program/move.h"
#include "smooth/exact_parts.h"
#include "smooth/smooth.h"

#include <stdbool.h>
#include <stdint.h>

/* The limit that governs the feed of a block. */
enum governor {
    GOVERNOR_PROGRAM,      /* the programmed feed */
    GOVERNOR_VELOCITY,     /* an axis's maximum velocity */
    GOVERNOR_ACCELERATION, /* centripetal acceleration on an arc */
    GOVERNOR_JERK,         /* jerk on an arc */
    GOVERNOR_CHORD,        /* chord error on an arc */
    GOVERNOR_SMOOTH,       /* a smoothed curve's acceleration and jerk */
    GOVERNOR_SHORT,        /* block of about one cycle: changes of direction must not pile up */
    GOVERNOR_RAMP /* no ceiling is reached: the block is passed while speeding up or slowing down */
};

/* What limits the feed at the end of a block. */
enum junction_kind {
    JUNCTION_PASSED,  /* full feed: the end is inside a span */
    JUNCTION_REDUCED, /* the change of direction or curvature needs a lower feed: landed */
    JUNCTION_STOP     /* rest: landed */
};

/*
 * How much of the axes' limits one unit of motion along the path needs, at most: from the curve's
 * bounds. Beside it stands what an arc adds; for a line, first is 0.
 */
struct block_shape {
    /* path acceleration at which the first straight-moving axis reaches its own */
    double line_a_mm_s2;
    double line_j_mm_s3;  /* likewise jerk */
    double first;         /* plane of an arc: |dx/ds| */
    double second;        /* |d2x/ds2|, 1/mm */
    double third;         /* |d3x/ds3|, 1/mm2 */
    double plane_a_mm_s2; /* acceleration that both axes of the plane can do */
    double plane_j_mm_s3;
};

struct block {
    struct move move; /* the canonical move it came from */
    uint32_t number;  /* of the motion, from 1; a wait has the number of the motion before it */
    bool continues;   /* another piece of the same move follows */
    enum junction_kind end;
    enum governor cap;  /* of feed_cap_mm_s */
    uint64_t start;     /* path position, path units (path_unit.h) */
    uint64_t length;    /* path units; 0: a wait, the axes stand */
    struct curve curve; /* rotary: programmed feeds count rad */
    double scale;     /* mm of the curve for a mm of path (scale.h); what follows is by the path */
    double length_mm; /* of the path */
    struct block_shape shape;

    double feed_program_mm_s; /* as programmed; infinite for a rapid */
    double feed_cap_mm_s;     /* axis velocities, chord error, junctions */
    /* feed_cap with curvature and jerk budget: never exceeded, whatever the override */
    double feed_max_mm_s;
    double a_mm_s2; /* along the path, what curvature and jerk budget leave at that feed */
    double j_mm_s3;

    /* part of the jerk limit that blocks near the junction at the end must leave */
    double jerk_budget_junction;
    double
        jerk_budget; /* part left to junctions: BLOCK_JERK_BUDGET_MAX until the block is closed */
    double feed_junction_mm_s; /* highest feed at which the junction at the end may be passed */
};

/* Fills b from a motion's curve. Its end is a stop until a junction is formed. */
void takt_block_set_motion(struct block *b, const struct move *move, const struct curve *curve,
                           const struct plan_limits *limits);

/*
 * Fills b with a piece of a smoothed curve (firmware/smooth), of which unit_mm of path are passed
 * in a second of its nominal time. Its end is a stop until takt_block_join_smooth().
 */
void takt_block_set_smooth(struct block *b, const struct smooth_piece *piece, double unit_mm);

/* The next piece of the same smoothed curve follows: nothing changes at the end of b. */
void takt_block_join_smooth(struct block *b, const struct block *next);

/* Fills b with something that happens while the axes stand. */
void takt_block_set_wait(struct block *b, const struct move *move);

/*
 * Lowers the ceiling of the feed to feed_mm_s, for the reason given; a higher value changes
 * nothing.
 */
void takt_block_cap_feed(struct block *b, double feed_mm_s, enum governor governor);

/* Sets the jerk budget of the junctions and what follows from it. */
void takt_block_set_jerk_budget(struct block *b, double jerk_budget);

/* The most this block will ever be allowed: if no junction took any of the jerk. */
double takt_block_top_feed(const struct block *b);

/*
 * The ceiling of the feed whatever is programmed, and what governs it; GOVERNOR_PROGRAM: there is
 * none.
 */
double takt_block_limit(const struct block *b, enum governor *governor);

static inline bool block_is_motion(const struct block *b)
{
    return move_is_motion(&b->move);
}

/* Does it move rotary axes? */
bool takt_block_turns(const struct block *b);

#endif
