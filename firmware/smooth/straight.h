/* The way on that always is one: straight along the route, from rest to rest. */
#ifndef TAKT_SMOOTH_STRAIGHT_H
#define TAKT_SMOOTH_STRAIGHT_H

#include "smooth/route.h"
#include "smooth/window.h"

/*
 * Makes the window's samples anew behind its first SMOOTH_FIXED: from rest to the route, where the curve is beside it, or
 * along it as far as it is straight, and to rest. Returns the pieces that do it.
 */
unsigned straight_on(struct window *w, const struct route *r);

#endif
