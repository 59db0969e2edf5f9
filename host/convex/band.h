/*
 * A symmetric positive definite matrix with a band: factor and solve in linear time.
 */
#ifndef TAKT_HOST_CONVEX_BAND_H
#define TAKT_HOST_CONVEX_BAND_H

#include <stddef.h>

/*
 * a: size columns below the diagonal and with it, each of width entries: entry k of column j is
 * (j + k, j). L D L^T in place: the diagonal becomes 1 / D. Rows beyond the matrix must be 0.
 */
void band_factor(double *a, size_t width, size_t size);
/* Solves in place; b is L^-1 of the right side already in the second. */
void band_solve(const double *a, size_t width, size_t size, double *b);
void band_back(const double *a, size_t width, size_t size, double *b);

#endif
