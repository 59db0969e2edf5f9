/*
 * Material that has not been cut: its top over X and Y, and so how deep a tool cuts there.
 *
 *        top(x, y)  ___.--.__        depth = top(x, y) - z, 0 where the tool is above it
 *     z ───────────▼────────────     top: between the four points of a grid around a place, linear in x and in y
 *
 * Outside of the grid there is none. Cutting does not take it away: a program is to pass each place
 * once.
 */
#ifndef TAKT_HOST_STOCK_H
#define TAKT_HOST_STOCK_H

#include <stddef.h>

struct stock {
    size_t columns, rows; /* of the grid, at least 2 each; 0: there is no stock */
    double *x_mm;         /* of each column, rising. All three are the owner's */
    double *y_mm;         /* of each row, rising */
    double *top_mm;       /* row by row */
};

/* Depth of a cut at a place, >= 0; stock must be there. */
double stock_depth_mm(const struct stock *stock, double x_mm, double y_mm, double z_mm);

#endif
