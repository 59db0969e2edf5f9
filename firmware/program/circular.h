/*
 * Circular motion: G2, G3, their centre from I J K or R.
 */
#ifndef TAKT_PROGRAM_CIRCULAR_H
#define TAKT_PROGRAM_CIRCULAR_H

#include "program/program.h"

/* G2, G3; argument: MOVE_ARC_CW or MOVE_ARC_CCW */
bool circular_move(struct program *p, const struct program_code *code);

#endif
