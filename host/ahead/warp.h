/*
 * Takes a step of the optimiser: moves the control points of a window and gives the curve new
 * knots, evenly spaced in its new time.
 */
#ifndef TAKT_HOST_AHEAD_WARP_H
#define TAKT_HOST_AHEAD_WARP_H

#include "ahead/window.h"

/*
 * change: (d, e) of the window's control points trail_ends ... cells - 1. The first and last ones,
 * so many, stay. The new time is lengthened to a whole number of knots. False: out of memory. The
 * caller frees result.
 */
bool warp_window(const struct window *w, size_t cells, double (*change)[4], bool timed,
                 struct trail *result);

#endif
