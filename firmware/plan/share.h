/*
 * What blocks leave of the axes' jerk to the joints near them. See joints.md.
 */
#ifndef TAKT_PLAN_SHARE_H
#define TAKT_PLAN_SHARE_H

#include "plan/block.h"

/*
 * Blocks that are not closed, at most: 3 cycles near a joint (joint.h), 8 blocks a cycle (block.c), and those at both
 * ends.
 */
#define SHARE_BLOCKS_MAX 28

struct path;

/* What the limits of a block are made of, as long as it is not closed. */
struct share_block {
    struct block_shape shape;
    double feed_program_mm_s;
    double feed_cap_mm_s;
    double least_s; /* in which it is passed */
    double share_joint;
    double share_near; /* the largest of the joints near this block, as far as they are known */
    enum governor cap;
};

/* A block is appended: no joint is near. */
void takt_share_begin(struct path *p, uint32_t index, const struct block *b);

/* A joint has been formed at its start or its end. */
void takt_share_note(struct path *p, uint32_t index, const struct block *b);

/*
 * The newest block has been joined to the one before it: tells that joint to the blocks near it, and closes those that
 * no further joint can be near to.
 */
void takt_share_spread(struct path *p);

/* The newest block ends at rest: closes all. */
void takt_share_close(struct path *p);

#endif
