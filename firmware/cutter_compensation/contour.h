/*
 * The contour being followed: pieces of way that may still change, in order, with the commands
 * between them.
 */
#ifndef TAKT_CUTTER_COMPENSATION_CONTOUR_H
#define TAKT_CUTTER_COMPENSATION_CONTOUR_H

#include "cutter_compensation/cutter_compensation.h"

/* The item at a place, 0 the oldest. */
struct compensation_item *takt_contour_item(struct cutter_compensation *o, unsigned place);

/* The rest of a corner, or of a way that is not left out. */
struct compensation_live *takt_contour_live(struct cutter_compensation *o,
                                            const struct compensation_item *item);

/* A new item at the end that is no piece of way. Needs room. */
void takt_contour_add(struct cutter_compensation *o, const struct compensation_item *item);

/* The programmed way of an item; of a corner, the one before it. False: there is none. */
bool takt_contour_wanted(const struct compensation_item *i, struct planar *wanted);

/* A point's coordinates in a plane, then those across it, the linear axis first; and back. */
void takt_contour_turned(enum plane plane, const struct point *p, double turned[AXIS_COUNT]);
void takt_contour_point(enum plane plane, const double turned[AXIS_COUNT], struct point *p);

/* Drops the oldest item. */
void takt_contour_drop_first(struct cutter_compensation *o);

/* The newest piece of way that is not left out; NULL: none. */
struct compensation_live *takt_contour_newest(struct cutter_compensation *o);

/*
 * Adds a piece that goes on where the newest ends, or, after an inner corner, where it crosses one
 * of the contour; it then begins there. A way that crosses none is swallowed, a corner then
 * forgotten.
 */
void takt_contour_continue(struct cutter_compensation *o, struct compensation_piece *piece);

/*
 * The same for a way behind an inner corner at the start of the programmed way. False: it crosses
 * none, and nothing has changed.
 */
bool takt_contour_meet_inside(struct cutter_compensation *o, struct compensation_piece *piece);

/* Such a way is swallowed. */
void takt_contour_leave_out(struct cutter_compensation *o, struct compensation_piece *piece);

#endif
