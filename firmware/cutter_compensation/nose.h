/*
 * Lathe tools are led by a point beside the centre of their nose, where the nose would end if it
 * were square. The contour is compensated for the nose's centre; the moves given out are those of
 * the point that is led.
 *
 *     3   8   4       the orientation names where that point lies, X up and Z to the right: by the radius along X,
 *     7   9   5       along Z, or both. At 9 and at 0, which mills have, it is the centre itself.
 *     2   6   1
 */
#ifndef TAKT_CUTTER_COMPENSATION_NOSE_H
#define TAKT_CUTTER_COMPENSATION_NOSE_H

#include "program/move.h"

/* From the nose's centre to the point that is led, first and second axis of the plane. */
void takt_nose_lead(const struct move *m, double lead_mm[2]);

/* Where the nose's centre is when the point that is led is at a point of the plane. */
void takt_nose_centre(const struct move *m, const double led[2], double centre[2]);

#endif
