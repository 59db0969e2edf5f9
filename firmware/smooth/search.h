/* Inside smooth: the search for a curve in the window. */
#ifndef TAKT_SMOOTH_SEARCH_H
#define TAKT_SMOOTH_SEARCH_H

#include "smooth/smooth.h"

/* Do this many pieces come to the end of the chain? */
bool takt_search_is_end(const struct smooth *s, unsigned pieces);
/* Does no way lead on? */
bool takt_search_is_stuck(const struct smooth *s);
/* What is asked of a curve and of the path. */
struct worth_window takt_search_asked(const struct smooth *s, union smooth_scratch *scratch);
/*
 * A curve is looked for from what was found before, and from nothing but what is kept. What is
 * ready and proved of the window is told.
 */
void takt_search_on(struct smooth *s, union smooth_scratch *scratch, struct verifier_verdict *v);
void takt_search_anew(struct smooth *s, union smooth_scratch *scratch, struct verifier_verdict *v);
/*
 * The order goes on to the end of what is ready; where the axes went back to the route it begins
 * there.
 */
void takt_search_follow(struct smooth *s, const struct verifier_verdict *v);

#endif
