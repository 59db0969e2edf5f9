/* Inside smooth: the window's samples. */
#ifndef TAKT_SMOOTH_FILL_H
#define TAKT_SMOOTH_FILL_H

#include "smooth/smooth.h"

/* Fills the window; false when more of the route must be known first. */
bool takt_fill(struct smooth *s);

/* The widest part of the tolerance that is of any use. */
float takt_fill_useful(const struct smooth *s);

/*
 * From rest: another part of the tolerance, nominal feeds for it, and so much of its interval; the
 * window is empty but for its start.
 */
void takt_fill_within(struct smooth *s, float part, float fine);

/* Where the axes stand, and nothing is ready: whatever ends there, a curve may begin anew. */
void takt_fill_begin_anew(struct smooth *s);

/*
 * May these axes, by bit, move too: has none of them longer ramps, or must change its rate more
 * slowly?
 */
bool takt_fill_fits(const struct smooth *s, unsigned axes);

#endif
