/*
 * The nominal feed of a route: where samples are first put. It needs not be exact, only near to
 * what can be done: what smoothing finds too fast or too slow is timed anew (timing.h).
 */
#ifndef TAKT_SMOOTH_NOMINAL_H
#define TAKT_SMOOTH_NOMINAL_H

#include "smooth/route.h"

/* Feed and acceleration of one element by its programmed feed and its curvature. */
void takt_nominal_set(struct route_element *e, const struct curve *curve, float per_mm,
                      const struct route *r);
/*
 * The corner before the newest element, the corners that now have more behind them, and the
 * energies of all.
 */
void takt_nominal_update(struct route *r);
/* All corners anew, for another part of the tolerance. */
void takt_nominal_again(struct route *r);

/* At this feed and acceleration, can all be met that is known to follow? */
bool takt_nominal_allows(const struct route *r, uint32_t element, double at_mm, float feed,
                         float acceleration);

#endif
