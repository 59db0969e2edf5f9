/*
 * Inside smooth, in the order in which they are called: the window is filled, a curve is looked for
 * in it, from rest several are tried, and the pieces are handed on.
 */
#ifndef TAKT_SMOOTH_PARTS_H
#define TAKT_SMOOTH_PARTS_H

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

/*
 * From rest: the quickest curve that is found, its first window as a search leaves it. Returns how
 * far it was gone along; in infinite time: there is none.
 */
struct worth_far takt_trials_from_rest(struct smooth *s, union smooth_scratch *scratch,
                                       struct verifier_verdict *v);

/*
 * What a curve takes longer where it begins, or ends, at rest: the axes stand while the rate rises,
 * and falls, s.
 */
double takt_smooth_rest_s(const struct smooth *s);
/*
 * The latest element that has been told: after a stop the curve goes on from where it can have come
 * to, which may be before.
 */
uint32_t takt_smooth_tell(struct smooth *s, uint32_t element);
/* One of those that are ready. */
void takt_smooth_set_piece(struct smooth *s, unsigned i, struct smooth_piece *piece);
/* The piece behind which, or before which, the axes stand becomes that in which they do. */
void takt_smooth_stand(struct smooth *s, struct smooth_piece *piece);

#endif
