/*
 * The programmed path itself: how long it takes, and its motions one by one. It comes to rest where
 * it turns, is inside every tolerance, and is taken where no curve is quicker, or none is found.
 */
#ifndef TAKT_SMOOTH_EXACT_H
#define TAKT_SMOOTH_EXACT_H

#include "smooth/window.h"

/* Does the exact path come to rest at the start of an element that is not the first? */
bool takt_exact_rests(const struct route *r, const struct smooth_limits *machine, uint32_t index);

/*
 * Seconds from rest at a place to the start of an element behind it, or to the end of the route:
 * index r->count.
 */
float takt_exact_time(const struct route *r, const struct smooth_limits *machine, double at_mm,
                      uint32_t element, uint32_t end);

/*
 * The next motion from where the window's axes rest: along the element to its end, after a line to
 * it where they are not on it and it is curved. The window rests at its end then. False: they are
 * there already.
 */
bool takt_exact_next(struct window *w, const struct route *r, struct move *move,
                     struct curve *curve);

#endif
