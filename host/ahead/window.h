/*
 * A window of the trajectory as a problem of the room convex: its rows for tolerance, corners,
 * velocity, acceleration and jerk.
 */
#ifndef TAKT_HOST_AHEAD_WINDOW_H
#define TAKT_HOST_AHEAD_WINDOW_H

#include "ahead/limits.h"
#include "ahead/path.h"
#include "ahead/trail.h"
#include "convex/problem.h"

/* A window: intervals from first on, of a trail along a path. */
struct window {
    const struct ahead_path *path;
    const struct ahead_limits *limits;
    const struct trail *trail;
    size_t first;
    double inside; /* part of the tolerance that is used */
};

/* Sets the rows of p, for p->cells intervals; place_mm: of every half knot from 2 first on. */
void window_build(struct problem *p, const struct window *w);

#endif
