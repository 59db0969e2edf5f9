/* Inside the compensation: what it gives out. */
#ifndef TAKT_CUTTER_COMPENSATION_AS_MOVE_H
#define TAKT_CUTTER_COMPENSATION_AS_MOVE_H

#include "cutter_compensation/cutter_compensation.h"

/*
 * An item, the first of those that o has, as the move that it has become; o->at is where that
 * begins.
 */
void takt_compensation_as_move(struct cutter_compensation *o, const struct compensation_item *i,
                               struct move *m);

#endif
