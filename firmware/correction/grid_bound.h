/*
 * Bounds of a grid's derivatives. Private to this room.
 */
#ifndef TAKT_CORRECTION_GRID_BOUND_H
#define TAKT_CORRECTION_GRID_BOUND_H

#include "correction/grid.h"

/* How often to differentiate along each input; at most three times. */
struct grid_order {
    unsigned along[TABLE_INPUTS_MAX];
};

/* Largest absolute derivative of a component, per step of the grid: mm or rad. */
double grid_bound(const struct grid *grid, const struct grid_order *order, unsigned component);

/* Largest third derivative of a component, per step: along one input or mixed. */
double grid_bound_third(const struct grid *grid, unsigned component);

#endif
