/*
 * The turning cycles G70 to G72: the profile is the subroutine of Q. Its lines are read and become
 * a profile instead of moves; behind its end the cycle goes along it (turning.h).
 */
#ifndef TAKT_PROGRAM_CONTOUR_H
#define TAKT_PROGRAM_CONTOUR_H

#include "program/program.h"

/* argument: enum turning_kind, and for G72 CONTOUR_FACING with it */
#define CONTOUR_FACING 0x10
bool takt_contour_start(struct program *p, const struct program_code *code);

/* Are lines read for a profile? */
static inline bool contour_is_open(const struct program *p)
{
    return p->cycle.contour_open;
}

/* The words that have been read, as part of the profile. False: p->error is set. */
bool takt_contour_take_line(struct program *p);

/*
 * A line has been read, well or not. Behind the profile's end the cycle begins. False: p->error is
 * set.
 */
bool takt_contour_follow(struct program *p, bool good);

/* The next move of a cycle that has begun; false: there is none. */
bool takt_contour_next(struct program *p, struct move *move);

#endif
