/*
 * Coming to rest at a place of a compiled curve, as single block asks for it, not as soon as
 * possible.
 *
 * Below a part of the full rate, HALT_RATE, the bounds of rate.h are taken as they are at that
 * rate, and so are constants: C of the change, M of the change's change. The way to rest from the
 * rate r, changing by c, is then known:
 *
 *     c >= 0   first until c = 0:                             c r / M + c^3 / 3 M^2, to r1 = r + c^2 / 2 M
 *     c < 0    braking from r1 = r + c^2 / 2 M has begun t = -c / M ago:            -(r1 t - M t^3 / 6)
 *     and from r1 on, with c1 = min(C, sqrt(M r1)):                                 r1 / 2 (r1 / c1 + c1 / M)
 *
 * What is used for the way is a little less than what a cycle may use, so that being off by a part
 * of a cycle is made up for.
 */
#ifndef TAKT_REPLAY_HALT_H
#define TAKT_REPLAY_HALT_H

#include "replay/rate.h"

#include <stdbool.h>

/* The highest rate from which a place is braked for. */
#define HALT_RATE 0.75

/*
 * Is the rate low and even enough to brake for a place? If not, takt_rate_step to HALT_RATE or less
 * makes it so.
 */
bool takt_halt_is_possible(const struct rate *r);

/* The way to rest, in cycles of the curve; with takt_halt_is_possible. */
double takt_halt_way(const struct rate *r);

/* A halt that is being come to. All 0: begins. */
struct halt {
    double cycles; /* until it stands there, once that is settled; else 0 */
};

/*
 * One cycle towards the rate to, 0 ... HALT_RATE, so that it comes to rest no later than at the end
 * of the way, finite; with takt_halt_way(r) <= way. Returns how far it leads, way itself when it
 * has come to rest there. Where the end is near it is driven to whatever is ordered.
 */
double takt_halt_step(struct halt *h, struct rate *r, double to, double way);

#endif
