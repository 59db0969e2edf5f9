/*
 * What bounds the exact path on an element of the route, and at the junctions between them: as
 * plan/block.c and plan/junction.c have it, which say why, in single precision. Left out is what
 * hardly ever binds: blocks of less than an eighth of a cycle, axes beside an arc of two radii, and
 * a tolerance that is less than a chord.
 */
#ifndef TAKT_SMOOTH_EXACT_COURSE_H
#define TAKT_SMOOTH_EXACT_COURSE_H

#include "smooth/braking.h"
#include "smooth/route.h"

#include <stdbool.h>

/* Of one element: mm of route and s. */
struct course {
    float length;
    float program; /* feed; infinite for a rapid */
    float cap;     /* what else bounds it, but for the curvature */
    float first;   /* derivatives in a curve's plane, 0: a line */
    float second;
    float third;
    struct braking_limits plane; /* in any direction of that, */
    struct braking_limits line;  /* and what other axes leave along the path */
};

/* A junction: the feed at which it is passed, 0: the axes rest; and the part of jerk it takes. */
struct course_joint {
    float feed;
    float budget;
};

/* From a place of the element on, or from its start. */
struct course takt_course_of(const struct route *r, const struct smooth_limits *machine,
                             double from_mm, uint32_t index);

/* The highest feed on it, under any override, and without one. budget: of jerk, for junctions. */
float takt_course_top(const struct course *c, float budget);
static inline float course_feed(const struct course *c, float budget)
{
    const float top = takt_course_top(c, budget);

    return c->program < top ? c->program : top;
}

/* What is left for ramps along it. */
struct braking_limits takt_course_ramps(const struct course *c, float budget);

/*
 * The junction at the start of an element that is not the first. Elements beside it that lose
 * nothing by its feed, or are too short for more, have that.
 */
struct course_joint takt_course_join(const struct route *r, const struct smooth_limits *machine,
                                     uint32_t index, struct course *before, struct course *after);

/* Is it passed without slowing down for it? */
static inline bool course_goes_on(const struct course_joint *j, const struct course *before,
                                  const struct course *after)
{
    return j->feed >= takt_course_top(before, 0.0f) || j->feed >= takt_course_top(after, 0.0f);
}

#endif
