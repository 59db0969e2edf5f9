/* Inside relaxing: corners of the route. */
#ifndef TAKT_SMOOTH_RELAX_CORNERS_H
#define TAKT_SMOOTH_RELAX_CORNERS_H

#include "smooth/relax.h"

/* Those that a condition of their own is worth, in their order, as many as there is room for. */
void takt_relax_find_corners(struct relax_corners *c, const struct window *w, const struct route *r,
                             float tolerance_mm);
/*
 * How near a piece must be to corners and bends, as a part of this tolerance: the lines through
 * setpoints are within all of the tolerance, as they leave the curve now.
 */
float takt_relax_most(const struct window *w, const struct route *r, unsigned piece,
                      float tolerance_mm);

#endif
