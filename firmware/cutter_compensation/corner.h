/*
 * Where two programmed ways meet.
 */
#ifndef TAKT_CUTTER_COMPENSATION_CORNER_H
#define TAKT_CUTTER_COMPENSATION_CORNER_H

#include "cutter_compensation/contour.h"

/*
 * Goes on from the contour's last programmed way to the next one: around an outer corner, through
 * an inner one, or straight on. left_mm: the radius, negative on the right side.
 */
void takt_corner_turn(struct cutter_compensation *o, struct compensation_piece *next,
                      double left_mm);

#endif
