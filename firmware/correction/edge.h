/*
 * What a position beyond the end of a table stands for: the end itself, reached without a kink.
 *
 * Within the table positions stand for themselves. Beyond the end at distance s, over the width d
 * of the last step,
 *
 *     u(s) = s (1 - q)^3 (1 + 3 q),  q = s / d;   u(s) = 0 for s >= d
 *
 * so that u' goes from 1 to 0 and u'' is 0 at both ends: a table read through u is continuous with
 * two derivatives everywhere, has its edge value from one step outside on, and is never read
 * further outside than 0.2 steps.
 */
#ifndef TAKT_CORRECTION_EDGE_H
#define TAKT_CORRECTION_EDGE_H

/* Largest of |u''| d and |u'''| d^2; |u'| <= 1. */
#define EDGE_SECOND_MAX 4.0
#define EDGE_THIRD_MAX  36.0

/*
 * position in steps, of a table that goes from 0 to last. *outside is set when it is beyond an end.
 */
double takt_edge_hold(double position, double last, unsigned *outside);

#endif
