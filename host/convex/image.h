/*
 * A cell's rows (rows.h) in its unknowns x, changes of the curve w and of time. Without modes these
 * are what the rows are on; else
 *
 *     change of the motors' or the tool's point j = sum_k (by_curve_k dw_(j+k) + by_time_k e_(j+k)),   k = 0 ... 2 modes
 *
 * with the weights of struct problem_side.
 */
#ifndef TAKT_HOST_CONVEX_IMAGE_H
#define TAKT_HOST_CONVEX_IMAGE_H

#include "convex/rows.h"

/* Unknowns of a cell with modes: four of each of 4 + 2 modes control points. */
#define IMAGE_UNKNOWNS ((4 + 3 * PROBLEM_STRAYS) * (4 + 2 * PROBLEM_MODES_MAX))

/* What rows are on, of both sides. */
struct image {
    double motor[CELL_UNKNOWNS];
    double tool[CELL_UNKNOWNS];
    double stray[PROBLEM_STRAYS][CELL_UNKNOWNS];
};

/* Valid as long as x and image are. */
struct rows_at image_of(const struct problem *p, size_t cell, const double *x, struct image *image);

/* b += G^T v in the unknowns; z as image_of has it. */
void image_transpose(const struct problem *p, size_t cell, const struct rows_at *z,
                     const double v[ROWS_MAX], double *b);

/* Sets the lower triangle of k, a square of as many unknowns, as rows_normal has it. */
void image_normal(const struct problem *p, size_t cell, const struct rows_at *z,
                  const double w[ROWS_MAX], const double m[ROWS_MAX], double *k);

/*
 * Stray tools swing as their rows say, to within what 1 / weight lets them: the squares of these
 * rows, times weight, are added to the lower triangle of k, and what they ask for at x to b.
 */
void image_swing(const struct problem *p, size_t cell, const double *x, double weight, double *k,
                 double *b);

#endif
