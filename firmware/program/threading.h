/*
 * G76: a thread in several cuts.
 *
 *     X
 *     |  start ----------------------------- end       drive line
 *     |    |                                  |
 *     |    | I                                          to the crest of the thread
 *     |    '--.----------------------------.--'
 *     |       | J first cut                             K: full depth of the thread, from the crest
 *     |       |____________________________|
 *     +---------------------------------------- Z
 *
 * The cut number n is J n^(1/R) deep, so that with R = 2 all cuts take away the same area; the last
 * ones, one and H more, K. Each starts further along by its depth times tan Q, so that it cuts with
 * one flank. E, L: over that length the thread begins (L1), ends (L2) or both (L3) at an angle.
 * Negative I: outside thread.
 */
#ifndef TAKT_PROGRAM_THREADING_H
#define TAKT_PROGRAM_THREADING_H

#include "program/program.h"

bool takt_threading_start(struct program *p, const struct program_code *code);

/* See takt_cycles_next. */
bool takt_threading_next(struct program *p, struct move *move);

#endif
