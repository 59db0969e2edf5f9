/*
 * Starting in the middle: everything before the chosen line is read as usual, but its moves are
 * dropped. When the line is reached for the first time, the machine is brought to where the line
 * starts:
 *
 *     up to the highest Z of what was dropped, or of the start if that is higher
 *     the tool, if it is another one
 *     the set-up of the part, as it was told last
 *     across, X Y and A B C, at that height
 *     spindle and coolant as they have to be
 *     down at F, or slowly when no F is known
 */
#ifndef TAKT_PROGRAM_APPROACH_H
#define TAKT_PROGRAM_APPROACH_H

#include "program/program.h"

void takt_approach_open(struct program *p);

/*
 * True when the line in the lexer is the chosen one, for the first time: the moves to it are
 * queued. *good is false when nobody can start here, p->error is set.
 */
bool takt_approach_begins(struct program *p, bool *good);

/*
 * The first half has been fetched: the second is queued. False: that is so already, and the line is
 * to be taken.
 */
bool takt_approach_goes_on(struct program *p);

/*
 * Drops the queued moves and notes how the part is set up and how high they go, until the line is
 * reached. False: the program has ended before, p->error is set.
 */
bool takt_approach_drop(struct program *p);

#endif
