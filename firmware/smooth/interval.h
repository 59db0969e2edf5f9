/*
 * Nominal time between the samples of a chain.
 */
#ifndef TAKT_SMOOTH_INTERVAL_H
#define TAKT_SMOOTH_INTERVAL_H

#include "smooth/route.h"

/*
 * What a way of a tolerance takes the quickest of the axes that move on the route, by the limits of its curve; at least a cycle,
 * and so long that none of them needs many windows to reach its velocity. s.
 */
double takt_interval_of(const struct smooth_limits *machine, const struct route *r,
                        double tolerance_mm);

#endif
