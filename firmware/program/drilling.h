/*
 * The moves of a drilling cycle under way, one by one: scripts, a row of which says rapid, feed,
 * wait, spindle or stop, and at which height.
 */
#ifndef TAKT_PROGRAM_DRILLING_H
#define TAKT_PROGRAM_DRILLING_H

#include "program/program.h"

/* The next move of p->cycle; false: the last has been made, and the cycle is over. */
bool takt_drilling_next(struct program *p, struct move *move);

#endif
