/*
 * The contour being followed: pieces of way that may still change, in order, with the commands between them.
 */
#ifndef TAKT_OFFSET_CONTOUR_H
#define TAKT_OFFSET_CONTOUR_H

#include "offset/offset.h"

/* The item at a place, 0 the oldest. */
struct offset_item *contour_item(struct offset *o, unsigned place);

/* A new item at the end, of this move, all else 0. Needs room. */
struct offset_item *contour_add(struct offset *o, enum offset_kind kind, const struct move *m);

/* The programmed way of an item; of a corner, the one before it. False: there is none. */
bool contour_wanted(const struct offset_item *i, struct planar *wanted);

/* A point in a plane. */
void contour_in_plane(enum plane plane, const struct point *p, double result[2]);

/* Drops the oldest item. */
void contour_drop_first(struct offset *o);

/* The newest piece of way that is not left out; NULL: none. */
struct offset_item *contour_newest(struct offset *o);

/*
 * Adds a piece that goes on where the newest ends, or, after an inner corner, where it crosses one of the contour. A
 * way that crosses none is swallowed, a corner then forgotten.
 */
void contour_continue(struct offset *o, const struct offset_item *piece);

/* The same for a way behind an inner corner at the start of the programmed way. */
void contour_continue_inside(struct offset *o, const struct offset_item *piece);

#endif
