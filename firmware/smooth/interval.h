/*
 * Nominal time between the samples of a chain.
 */
#ifndef TAKT_SMOOTH_INTERVAL_H
#define TAKT_SMOOTH_INTERVAL_H

#include "smooth/limits.h"

/*
 * What a way of the tolerance takes the quickest axis, by the limits of the curve; at least a cycle, and so long that no axis of
 * the machine needs many windows of so many samples to reach its velocity. s.
 */
double interval_of(const struct smooth_limits *machine, const struct smooth_limits *curve,
                   double tolerance_mm, unsigned samples);

#endif
