/*
 * The rows of one cell: values, products with a step, and their part of the normal matrix.
 */
#ifndef TAKT_HOST_CONVEX_ROWS_H
#define TAKT_HOST_CONVEX_ROWS_H

#include "convex/problem.h"

/* For a cell: both sides of every axis's limits, the feed, the balls, and both bounds of e. */
#define ROWS_AXIS 0
enum { ROWS_FEED = 3 * FORM_COUNT * 2 };
#define ROWS_BALL (ROWS_FEED + 1)
#define ROWS_TIME (ROWS_BALL + CELL_BALLS)
#define CELL_ROWS (ROWS_TIME + 2)
/* And the balls of stray tools, behind them. */
#define ROWS_MAX (CELL_ROWS + PROBLEM_STRAYS * STRAY_BALLS)

static inline int rows_count(const struct problem *p)
{
    return CELL_ROWS + (int)p->strays * STRAY_BALLS;
}

/* What the rows are on: of four control points x, y, z and e. */
#define CELL_UNKNOWNS 16

/*
 * Limits and bounds of time are on the motors' control points, the tolerance on the tool's: without
 * modes both are the same, in one place, and so are what is added up below. The tool's e is not
 * used.
 */
struct rows_at {
    const double *motor, *tool; /* CELL_UNKNOWNS each */
    const double *stray[PROBLEM_STRAYS];
};

struct rows_sum {
    double *motor, *tool;
    double *stray[PROBLEM_STRAYS];
};

struct rows_square {
    double (*motor)[CELL_UNKNOWNS];
    double (*tool)[CELL_UNKNOWNS];
    double (*stray[PROBLEM_STRAYS])[CELL_UNKNOWNS];
};

/* c(z) of every row: > 0 inside. Rows that do not apply are 1. */
void rows_value(const struct problem *p, size_t cell, const struct rows_at *z, double c[ROWS_MAX]);

/* G dz of every row, G = -dc/dz at z. */
void rows_product(const struct problem *p, size_t cell, const struct rows_at *z,
                  const struct rows_at *dz, double product[ROWS_MAX]);

/* b += G^T v */
void rows_transpose(const struct problem *p, size_t cell, const struct rows_at *z,
                    const double v[ROWS_MAX], const struct rows_sum *b);

/* The lower triangle of k += G^T W G + sum_i m_i (second derivative of -c_i). */
void rows_normal(const struct problem *p, size_t cell, const struct rows_at *z,
                 const double w[ROWS_MAX], const double m[ROWS_MAX], const struct rows_square *k);

#endif
