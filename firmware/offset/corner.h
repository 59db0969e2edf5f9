/*
 * Where two programmed ways meet.
 */
#ifndef TAKT_OFFSET_CORNER_H
#define TAKT_OFFSET_CORNER_H

#include "offset/contour.h"

/*
 * Goes on from the contour's last programmed way to the next one: around an outer corner, through an inner one, or
 * straight on. left_mm: the radius, negative on the right side.
 */
void takt_corner_turn(struct offset *o, struct offset_piece *next, double left_mm);

#endif
