/*
 * Junctions between two blocks on the exact path: how fast a change of direction or of curvature
 * may be passed.
 */
#ifndef TAKT_PLAN_JUNCTION_H
#define TAKT_PLAN_JUNCTION_H

#include "plan/block.h"
#include "plan/limits.h"

/*
 * Forms the junction between two motions that follow each other: sets before->end,
 * feed_junction_mm_s, jerk_budget_junction and, for blocks of few cycles, the ceiling of both.
 */
void takt_junction_form(struct block *before, struct block *after,
                        const struct plan_limits *limits);

/* The end of b is a stop for good: nothing joins it. */
void takt_junction_stop(struct block *b);

#endif
