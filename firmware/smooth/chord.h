/*
 * The lines through setpoints, a cycle apart, leave the curve by |x''| cycle^2/8 at most: where
 * they cut a corner, and beside a bend, it must be nearer by that. Beside a line they are as near
 * as setpoints are.
 */
#ifndef TAKT_SMOOTH_CHORD_H
#define TAKT_SMOOTH_CHORD_H

#include "smooth/window.h"

/* Sets how they leave a curve with this interval. */
void takt_chord_init(struct chord_reach *chord, double cycle_s, double interval_s);
/*
 * How far those that are in a piece may leave it, over all axes, in which mm and degrees count
 * alike.
 */
float takt_chord_leaves(const struct window *w, const struct route *r, unsigned piece);

#endif
