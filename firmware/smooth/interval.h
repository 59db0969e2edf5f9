/*
 * Nominal time between the samples of a chain.
 */
#ifndef TAKT_SMOOTH_INTERVAL_H
#define TAKT_SMOOTH_INTERVAL_H

#include "smooth/route.h"

/*
 * What a way of a tolerance takes the quickest of these axes, by the limits of a curve on the
 * route; at least a cycle, and so long that none of them needs many windows to reach its velocity.
 * whole: nothing follows what is known of the route. s.
 */
double takt_interval_of(const struct smooth_limits *machine, const struct route *r, unsigned axes,
                        double tolerance_mm, bool whole);

#endif
