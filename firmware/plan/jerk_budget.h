/*
 * What blocks leave of the axes' jerk to the junctions near them. See junctions.md.
 */
#ifndef TAKT_PLAN_JERK_BUDGET_H
#define TAKT_PLAN_JERK_BUDGET_H

#include "plan/block.h"

/*
 * Blocks that are not closed, at most: 3 cycles near a junction (junction.h), 8 blocks a cycle
 * (block.c), and those at both ends.
 */
#define JERK_BUDGET_BLOCKS_MAX 28

struct path;

/* What the limits of a block are made of, as long as it is not closed. */
struct jerk_budget_block {
    struct block_shape shape;
    double feed_program_mm_s;
    double feed_cap_mm_s;
    double least_s; /* in which it is passed */
    double jerk_budget_junction;
    /* the largest of the junctions near this block, as far as they are known */
    double jerk_budget_near;
    enum governor cap;
};

/* A block is appended: no junction is near. */
void takt_jerk_budget_begin(struct path *p, uint32_t index, const struct block *b);

/* A junction has been formed at its start or its end. */
void takt_jerk_budget_note(struct path *p, uint32_t index, const struct block *b);

/*
 * The newest block has been joined to the one before it: tells that junction to the blocks near it,
 * and closes those that no further junction can be near to.
 */
void takt_jerk_budget_spread(struct path *p);

/* The newest block ends at rest: closes all. */
void takt_jerk_budget_close(struct path *p);

#endif
