/*
 * Nominal time between the samples of a chain.
 */
#ifndef TAKT_SMOOTH_INTERVAL_H
#define TAKT_SMOOTH_INTERVAL_H

#include "smooth/limits.h"

/* What a way of the tolerance takes the quickest of the axes that move, by the limits of the curve; at least a cycle. s. */
double interval_of_tolerance(const struct smooth_limits *curve, unsigned axes, double tolerance_mm);
/* So long that none of them needs many windows of so many samples to reach its velocity, by the limits of the machine. */
double interval_of_ramps(const struct smooth_limits *machine, unsigned axes, unsigned samples);

#endif
