/*
 * The motions of the programmed path itself, one by one. It comes to rest where
 * it turns, is inside every tolerance, and is taken where no curve is quicker, or none is found.
 */
#ifndef TAKT_SMOOTH_EXACT_H
#define TAKT_SMOOTH_EXACT_H

#include "smooth/window.h"

/*
 * The next motion from where the window's axes rest: along the element to its end, after a line to
 * it where they are not on it and it is curved. The window rests at its end then. False: they are
 * there already.
 */
bool takt_exact_next(struct window *w, const struct route *r, struct move *move,
                     struct curve *curve);

#endif
