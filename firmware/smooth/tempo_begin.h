/* Shared by the sources of the tempo. */
#ifndef TAKT_SMOOTH_TEMPO_BEGIN_H
#define TAKT_SMOOTH_TEMPO_BEGIN_H

#include "smooth/tempo.h"

/* Rates between 0.15 and 1.5: what is farther off is left to the next window. */
#define RATE_SQUARED_MIN  0.0225f
#define RATE_SQUARED_MOST 2.25f

/*
 * Of p->pieces from the window's first sample on: differences, their limits, and the most that b
 * may be.
 */
void takt_tempo_begin(struct tempo *p, const struct window *w, const struct route *r);

#endif
