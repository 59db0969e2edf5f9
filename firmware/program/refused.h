/*
 * What a refused line leaves for later ones: errors that only come of it are not told.
 */
#ifndef TAKT_PROGRAM_REFUSED_H
#define TAKT_PROGRAM_REFUSED_H

#include "program/program.h"

/*
 * The line has been taken, or p->error says why it has not. False: the error is to be told; it has
 * not come of a line that has been refused before.
 */
bool takt_refused_judge(struct program *p, bool good);

#endif
