/*
 * G2.2, G3.2: along an involute of a circle. I J K of the plane lead from the start to the centre
 * of the base circle (with G90.1 they are it), R is its radius.
 *
 * A point of the involute at the distance d from the centre has been unrolled by the angle
 * phi = sqrt((d/r)^2 - 1); its radius vector has turned meanwhile by
 *
 *     inv = phi - atan phi
 *
 * Going outward the radius vector turns the way of the unrolling, going inward the other way. So a
 * G3.2 outward and a G2.2 inward lie on an involute unrolled counter-clockwise, the others on its
 * mirror image, and between start and end the vector turns, in the sense of the code, by |inv(end)
 * - inv(start)|. Involutes of one circle that differ by the angle e are r e apart everywhere,
 * measured across them: so far is an end off the involute through the start. What is then run goes
 * through both ends (geometry/involute.c).
 */
#ifndef TAKT_PROGRAM_INVOLUTE_H
#define TAKT_PROGRAM_INVOLUTE_H

#include "program/program.h"

/* argument: MOVE_INVOLUTE_CW or MOVE_INVOLUTE_CCW */
bool takt_involute_move(struct program *p, const struct program_code *code);

#endif
