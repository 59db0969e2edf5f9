/*
 * Joints between two blocks on the exact path: how fast a change of direction or of curvature may be passed.
 */
#ifndef TAKT_PLAN_JOINT_H
#define TAKT_PLAN_JOINT_H

#include "plan/block.h"
#include "plan/limits.h"

/*
 * Forms the joint between two motions that follow each other: sets before->end, feed_joint_mm_s, share_joint and, for
 * blocks of few cycles, the ceiling of both.
 */
void takt_joint_form(struct block *before, struct block *after, const struct plan_limits *limits);

/* The end of b is a stop for good: nothing joins it. */
void takt_joint_stop(struct block *b);

#endif
