/*
 * A grid over three axes, close to where it was evaluated last: value, first and second derivatives at an anchor (a
 * patch) stand for the spline as long as the axes stay near it, for a fraction of the cost. The next patch is made ahead
 * of where the axes go, a part of it in each cycle, while the last one holds. See README.md.
 */
#ifndef TAKT_CORRECTION_GRID_PATCH_H
#define TAKT_CORRECTION_GRID_PATCH_H

#include "correction/grid.h"

/* 1, x, y, z, x^2, y^2, z^2, xy, xz, yz; in the order of the grid's inputs. */
#define GRID_PATCH_TERMS  10
#define GRID_PATCH_INPUTS 3

/* Sums that they are made of. */
#define GRID_PATCH_SUMS 6

/* B-splines and their first and second derivatives, 4 of each. */
#define GRID_PATCH_WEIGHTS 12

/* Largest error of a patch: about what single precision rounds away of a correction of 0.1 mm. */
#define GRID_PATCH_ERROR_MM 4e-9

struct grid_patch {
    bool valid;
    bool near_end; /* of the table, along some input */
    double anchor_mm[GRID_PATCH_INPUTS];
    float term[GRID_PATCH_TERMS][GRID_COMPONENTS];
};

/* All 0: nothing is known yet. */
struct grid_patches {
    struct grid_patch
        used; /* where it is not valid, its anchor is where the axes were in the last cycle */
    struct grid_patch next;
    float way
        [GRID_PATCH_INPUTS]; /* from the anchor of used in the last cycle, in steps of each input */
    uint8_t stage;           /* of making next; 0: it is not being made */
    size_t first;            /* where its stencil begins */
    float weight[GRID_PATCH_INPUTS][GRID_PATCH_WEIGHTS];
    float sum[GRID_PATCH_SUMS][4]; /* of the component being made, along the first input */
};

/* How far patches of a grid are good, by its bounds. */
float grid_patch_reach(const struct grid *grid);

/* As grid_add, for a point near that of the call before, within GRID_PATCH_ERROR_MM of it. */
unsigned grid_patch_add(const struct grid *grid, struct grid_patches *patches,
                        const struct point *at, float weight, float k[AXIS_COUNT]);

#endif
