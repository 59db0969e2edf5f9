/*
 * A symmetric positive definite matrix with a band of four blocks of four: factor and solve in linear time.
 */
#ifndef TAKT_HOST_AHEAD_BAND_H
#define TAKT_HOST_AHEAD_BAND_H

#include <stddef.h>

/* A column below the diagonal and with it: entry [j][k] is (j + k, j). */
#define BAND_WIDTH 16

/* L D L^T in place: the diagonal becomes 1 / D. Rows beyond the matrix must be 0. */
void band_factor(double (*a)[BAND_WIDTH], size_t size);
/* Solves in place. */
void band_solve(double (*a)[BAND_WIDTH], size_t size, double *b);

#endif
