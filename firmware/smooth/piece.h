/*
 * What is handed on: the piece of the curve that is taken next, and those in which the axes stand
 * before and behind a curve.
 */
#ifndef TAKT_SMOOTH_PIECE_H
#define TAKT_SMOOTH_PIECE_H

#include "smooth/smooth.h"

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
