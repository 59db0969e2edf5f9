/*
 * The order of setpoints along a path with a tolerance, by the walk of tests/bench/hunting, which
 * shares no code with the firmware: is there a way along both, never backwards, with no more than
 * the tolerance between them?
 */
#ifndef TAKT_TESTS_SECOND_VERIFIER_H
#define TAKT_TESTS_SECOND_VERIFIER_H

#include "program/move.h"

/* A path of linear axes from 0. */
void second_begin(unsigned axes);
/* Goes on by a line or an arc, whose length is not 0. */
void second_add_motion(const struct move *m);
void second_add_setpoint(const struct point *p);
/*
 * 1, or the smallest factor on the tolerance with which there is a way to the end of both; ended: a
 * reset has ended it, there must be a way to the last setpoint.
 */
double second_order(bool ended);

#endif
