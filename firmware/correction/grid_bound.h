/*
 * Bounds of a grid's derivatives, worked out once when it is loaded: to look through all
 * coefficients for each of them takes far longer than to plan a block.
 */
#ifndef TAKT_CORRECTION_GRID_BOUND_H
#define TAKT_CORRECTION_GRID_BOUND_H

#include "correction/grid.h"

/* In place of an input: the derivative is of a lower order. */
#define GRID_NO_INPUT TABLE_INPUTS_MAX

/* Fills grid->bound. To be called when coefficients and inputs are there. */
void takt_grid_bound_all(struct grid *grid);

/*
 * Largest absolute derivative of a component by inputs a, b and c, per step of the grid: mm or rad.
 */
float takt_grid_bound(const struct grid *grid, unsigned component, unsigned a, unsigned b,
                      unsigned c);

/* Largest third derivative of a component, per step: along one input or mixed. */
float takt_grid_bound_third(const struct grid *grid, unsigned component);

#endif
