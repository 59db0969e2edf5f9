/* Inside relaxing: what its rows count. */
#ifndef TAKT_SMOOTH_RELAX_SCALE_H
#define TAKT_SMOOTH_RELAX_SCALE_H

#include "smooth/relax.h"

/* By the window's interval and the route's limits; the tolerance is the unit. */
void takt_relax_set_scale(struct relax_scale *s, const struct window *w, const struct route *r,
                          float tolerance_mm);

#endif
