/*
 * Straight motion: G0, G1, G33, G33.1, and the way to the reference positions G28, G30.
 */
#ifndef TAKT_PROGRAM_STRAIGHT_H
#define TAKT_PROGRAM_STRAIGHT_H

#include "program/program.h"

/* G0, G1; argument: MOVE_RAPID or MOVE_FEED */
bool takt_straight_move(struct program *p, const struct program_code *code);
/*
 * G28, G30; argument: the first of the parameters with the position. The axes with a word go to the
 * point it asks for and then on to the reference position; without any word all axes go there at
 * once.
 */
bool takt_straight_to_reference(struct program *p, const struct program_code *code);
/* G28.1, G30.1: the position becomes the reference position; argument as above */
bool takt_straight_store_reference(struct program *p, const struct program_code *code);
/* G33: a line that advances K per revolution of the spindle */
bool takt_straight_thread(struct program *p, const struct program_code *code);
/* G33.1: the same to the end and back, out at I times the speed */
bool takt_straight_tap(struct program *p, const struct program_code *code);
/* G80 */
bool takt_straight_cancel(struct program *p, const struct program_code *code);

#endif
