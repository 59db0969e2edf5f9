/*
 * A grid over three axes, close to where it was evaluated last: value, first and second derivatives at an anchor stand
 * for the spline as long as the axes stay near it, for a fraction of the cost. See README.md.
 */
#ifndef TAKT_CORRECTION_GRID_PATCH_H
#define TAKT_CORRECTION_GRID_PATCH_H

#include "correction/grid.h"

/* 1, x, y, z, x^2, y^2, z^2, xy, xz, yz; in the order of the grid's inputs. */
#define GRID_PATCH_TERMS  10
#define GRID_PATCH_INPUTS 3

/* Largest error of a patch: about what single precision rounds away of a correction of 0.1 mm. */
#define GRID_PATCH_ERROR_MM 4e-9

/* All 0: no patch yet. */
struct grid_patch {
    bool valid;
    bool near_end; /* of the table, along some input */
    double anchor_mm[GRID_PATCH_INPUTS];
    double before_mm[GRID_PATCH_INPUTS]; /* of the cycle before */
    float term[GRID_PATCH_TERMS][GRID_COMPONENTS];
};

/* How far patches of a grid are good: to be called by grid_set. */
float grid_patch_reach(const struct grid *grid);

/* As grid_add, for a point near that of the call before, within GRID_PATCH_ERROR_MM of it. */
unsigned grid_patch_add(const struct grid *grid, struct grid_patch *patch, const struct point *at,
                        float weight, float k[AXIS_COUNT]);

#endif
