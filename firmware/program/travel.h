/*
 * The limits of the axes: no motion may leave them, not even between its ends.
 */
#ifndef TAKT_PROGRAM_TRAVEL_H
#define TAKT_PROGRAM_TRAVEL_H

#include "program/program.h"

/* False: p->error names the axis and the coordinate (mm or degrees). */
bool travel_check(struct program *p, const struct move *m);

#endif
