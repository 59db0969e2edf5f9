/*
 * Solves a problem (problem.h) by Mehrotra's interior-point method, in time linear in its length.
 *
 * Each row is c(z) >= 0 in the unknowns z, or is broken by t at the price PRICE t:
 *
 *     c(z) + t = s,   s, t >= 0,   s m = mu,   t (PRICE - m) = mu
 *
 * with the multiplier 0 <= m <= PRICE. Eliminating all but z leaves a band matrix (band.h) of
 * problem_each unknowns a knot, as wide as the unknowns of one cell. How stray tools swing is no
 * row but squares in that matrix, of a high price.
 */
#ifndef TAKT_HOST_CONVEX_INTERIOR_H
#define TAKT_HOST_CONVEX_INTERIOR_H

#include "convex/problem.h"

#include <stdbool.h>

struct interior; /* memory for problems of up to so many cells, with so many modes and strays */

/* NULL: out of memory. */
struct interior *interior_new(size_t cells_max, unsigned modes, unsigned strays);
void interior_free(struct interior *w);

/*
 * The change (d, e) of control points problem_ends ... cells - 1, finite whatever the problem is;
 * valid until the next call.
 */
double (*interior_solve(struct interior *w, const struct problem *p))[4];

#endif
