/*
 * Nominal time between the samples of a chain.
 */
#ifndef TAKT_SMOOTH_INTERVAL_H
#define TAKT_SMOOTH_INTERVAL_H

#include "smooth/route.h"

/* The shortest one, s: so many pieces a cycle are planned at most. */
double takt_interval_least(const struct smooth_limits *machine);

/*
 * What a way of a tolerance takes the quickest of these axes; no less than the shortest, and so
 * long that none of them needs many windows to reach its velocity. whole: nothing follows what is
 * known of the route. s.
 */
double takt_interval_of(const struct smooth_limits *machine, const struct route *r, unsigned axes,
                        double tolerance_mm, bool whole);

/*
 * How far a route leads away from where it begins, in the direction of an axis; of bends no less.
 * mm, weighted.
 */
double takt_interval_reach(const struct route *r);

#endif
