/*
 * Shared by the sources of relaxing: its linear system, the corners of the route, and what its rows
 * count.
 */
#ifndef TAKT_SMOOTH_RELAX_PARTS_H
#define TAKT_SMOOTH_RELAX_PARTS_H

#include "smooth/relax.h"

/* K' R K for the tolerance weighed so much, and factors it: of the samples that are not fixed. */
void takt_bands_build(struct relax *x, const struct window *w, const struct route *r, float weight);
/* Solves for the steps of one group of lanes, and takes them. */
void takt_bands_step(struct relax *x, struct window *w, unsigned group);

/* Those that a condition of their own is worth, in their order, as many as there is room for. */
void takt_relax_find_corners(struct relax_corners *c, const struct window *w, const struct route *r,
                             float tolerance_mm);
/*
 * How near a piece must be to corners and bends, as a part of this tolerance: the lines through
 * setpoints are within all of the tolerance, as they leave the curve now.
 */
float takt_relax_most(const struct window *w, const struct route *r, unsigned piece,
                      float tolerance_mm);

/* By the window's interval and the route's limits; the tolerance is the unit. */
void takt_relax_set_scale(struct relax_scale *s, const struct window *w, const struct route *r,
                          float tolerance_mm);

#endif
