/*
 * A block in the window: a move, and what is known of its feed.
 *
 *    v |        ________ feed_max            rules of the diagram (seed 003 section 1):
 *      |       /        \                    1. never brake at the start: feed_max >= feed at the start
 *      |  ____/          \____               2. never accelerate at the end: feed_end <= feed_max
 *      |  start            end               3. acceleration is zero at both ends
 *      +-----------------------> s           4. the block is long enough for its ramps, else feeds come down
 */
#ifndef TAKT_PLAN_BLOCK_H
#define TAKT_PLAN_BLOCK_H

#include "geometry/curve.h"
#include "plan/limits.h"
#include "plan/ramp.h"
#include "plan/segment.h"
#include "program/move.h"

#include <stdbool.h>
#include <stdint.h>

/*
 * How much of the axes' limits one unit of motion along the path needs, at most: from the curve's bounds.
 * Beside it stands what an arc adds; for a line, first is 0.
 */
struct block_shape {
    double
        line_a_mm_s2; /* path acceleration at which the first straight-moving axis reaches its own */
    double line_j_mm_s3;  /* likewise jerk */
    double first;         /* plane of an arc: |dx/ds| */
    double second;        /* |d2x/ds2|, 1/mm */
    double third;         /* |d3x/ds3|, 1/mm2 */
    double plane_a_mm_s2; /* acceleration that both axes of the plane can do */
    double plane_j_mm_s3;
};

struct block {
    struct move move;
    uint32_t number; /* of the motion, from 1 */
    double length_mm;
    bool rotary; /* the path is counted in rad: no linear axis moves */
    struct block_shape shape;

    double
        feed_cap_mm_s; /* cruise feed may not exceed: programmed feed, axis velocities, chord error, joints */
    enum governor governor;
    double feed_max_mm_s;    /* cruise feed ceiling with curvature and share taken into account */
    struct ramp_limits ramp; /* along the path, what curvature and share leave */

    enum joint_kind end;
    bool closed;            /* what follows is known: end, share and joint feed are final */
    double share_start;     /* part of the jerk limit used by the joint at the start */
    double share;           /* part of the jerk limit left to both joints, 0 ... BLOCK_SHARE_MAX */
    double feed_joint_mm_s; /* highest feed at which the joint at the end may be passed */
    double
        feed_end_mm_s; /* planned feed at the end: the rest of the window can be stopped from it */
};

/* Part of the jerk limit that changes of direction and curvature at joints may use; ramps then have the rest. */
#define BLOCK_SHARE_MAX 0.5

/*
 * Fills b from a motion's curve. Its end is a stop until a joint is formed, and its share is the largest, so that what
 * comes later can only raise its limits: a plan once made stays possible.
 */
void block_set_motion(struct block *b, const struct move *move, const struct curve *curve,
                      const struct plan_limits *limits);

/* Fills b with something that happens while the axes stand. */
void block_set_wait(struct block *b, const struct move *move);

/* Lowers the cruise feed to feed_mm_s, for the reason given; a higher value changes nothing. */
void block_cap_feed(struct block *b, double feed_mm_s, enum governor governor);

/* Sets the share left to the joints and what follows from it. */
void block_set_share(struct block *b, double share);

/* Cruise feed if no joint took a share: the most this block will ever be allowed. */
double block_top_feed(const struct block *b);

/* What governs the cruise feed. */
enum governor block_governor(const struct block *b);

/*
 * Highest feed at the block's start from which its planned end, or a lower one, can be reached. Never falls while the
 * plan of what follows improves.
 */
double block_start_feed(const struct block *b);

/* Highest end feed up to feed_end that start_mm_s reaches within the block. */
double block_end_feed(const struct block *b, double start_mm_s);

#endif
