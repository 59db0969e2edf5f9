/*
 * The linear system of the relaxation: symmetric, a diagonal and three bands on each side of it,
 * for each group of lanes.
 */
#ifndef TAKT_SMOOTH_BANDS_H
#define TAKT_SMOOTH_BANDS_H

#include "smooth/relax.h"

/* K' R K for the tolerance weighed so much, and factors it: of the samples that are not fixed. */
void takt_bands_build(struct relax *x, const struct window *w, const struct route *r, float weight);
/* Solves for the steps of one group of lanes, and takes them. */
void takt_bands_step(struct relax *x, struct window *w, unsigned group);

#endif
