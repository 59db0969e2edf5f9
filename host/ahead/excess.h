/*
 * How far a trajectory is beyond what it has to keep.
 */
#ifndef TAKT_HOST_AHEAD_EXCESS_H
#define TAKT_HOST_AHEAD_EXCESS_H

#include "ahead/window.h"

/* The part of the tolerance that counts as kept at the places that are measured. */
#define EXCESS_TOLERANCE_PART 0.985

/* How far along the path a closest point is looked for. */
#define EXCESS_REACH_MM 0.3

/*
 * p: the problem built for the window. Sets the trail's beyond of every interval of the window: the
 * largest of velocity, acceleration, jerk and feed over its limit and of the distance over its
 * tolerance; <= 1: legal. Returns the largest.
 */
double excess_measure(const struct window *w, const struct problem *p);

#endif
