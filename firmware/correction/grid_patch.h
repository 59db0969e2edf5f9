/*
 * A grid over three axes, close to where it was evaluated last: value, first and second derivatives
 * at an anchor (a patch) stand for the spline as long as the axes stay near it, for a fraction of
 * the cost. The next patch is made ahead of where the axes go, a part of it in each cycle, while
 * the last one holds; then one goes over into the other smoothly. See README.md.
 */
#ifndef TAKT_CORRECTION_GRID_PATCH_H
#define TAKT_CORRECTION_GRID_PATCH_H

#include "correction/grid.h"

/* 1, y, z, y^2, yz, z^2, x, xy, xz, x^2; in the order of the grid's inputs. */
#define GRID_PATCH_TERMS  10
#define GRID_PATCH_INPUTS 3

/* Sums that they are made of. */
#define GRID_PATCH_SUMS 6

/* B-splines, their first derivatives, and half the second ones: 4 of each. */
#define GRID_PATCH_WEIGHTS 12

/*
 * Error of a patch from which on a better one is made: what single precision rounds away of a
 * correction of 0.1 mm. Axes that stand, or creep, are corrected so well.
 */
#define GRID_PATCH_NEAR_MM 4e-9

/*
 * A patch is used at most this many times as far as it is that good, by axes that go fast; its
 * error there.
 */
#define GRID_PATCH_FAR      18
#define GRID_PATCH_ERROR_MM (GRID_PATCH_NEAR_MM * GRID_PATCH_FAR * GRID_PATCH_FAR * GRID_PATCH_FAR)

struct grid_patch {
    bool valid;    /* false: this stands for the spline itself */
    bool near_end; /* of the table, along some input */
    double anchor_mm[GRID_PATCH_INPUTS];
    float way[GRID_PATCH_INPUTS]; /* from there to where the axes are, in steps of each input */
    float term[GRID_COMPONENTS][GRID_PATCH_TERMS];
};

/* All 0: nothing is known yet. */
struct grid_patches {
    struct grid_patch patch[2];
    /* one of them; if it is not valid, its anchor is where the axes were in the last cycle */
    uint8_t used;
    uint8_t stage;           /* of making the other one, or of going over to it; 0: neither */
    uint8_t line, component; /* of it that come next */
    bool is_known;           /* where the axes were */
    bool is_ready;           /* there has been a patch, or the axes are too fast for any */
    float speed;             /* steps of all inputs together in the last cycle */
    unsigned outside;        /* bit i: axis i is beyond the end of the table */
    size_t first;            /* where the stencil of the other one begins */
    float weight[GRID_PATCH_INPUTS][GRID_PATCH_WEIGHTS];
    float sum[GRID_PATCH_SUMS][4];
};

/* How patches of a grid are made: sets reach, fastest and ready, by its bounds. */
void takt_grid_patch_set_pace(struct grid *grid);

/*
 * Once in every cycle before anything is added: makes the first patch. True: it is there, or the
 * axes are too fast for any; nothing has been done.
 */
bool takt_grid_patch_prepare(const struct grid *grid, struct grid_patches *patches,
                             const struct point *at);

/*
 * As takt_grid_add, once in every cycle, within GRID_PATCH_ERROR_MM of it. Makes a part of the next
 * patch.
 */
unsigned takt_grid_patch_add(const struct grid *grid, struct grid_patches *patches,
                             const struct point *at, float weight, float k[AXIS_COUNT]);

/*
 * The jerk that one patch going over into the other takes of a corrected axis at most, mm/s3.
 * third: its largest third derivative by steps; speed_per_s: the largest of the axes, in steps, all
 * together. Velocity and acceleration that it takes are below GRID_PATCH_VELOCITY and
 * GRID_PATCH_ACCELERATION of it, in cycles.
 */
#define GRID_PATCH_VELOCITY     4.0
#define GRID_PATCH_ACCELERATION 2.0

float takt_grid_patch_jerk(const struct grid *grid, float third, float speed_per_s, float cycle_s);

/*
 * So much more than that of the spline the slope of a patch may be, mm per step: 3
 * error / distance.
 */
static inline float grid_patch_slope(const struct grid *grid)
{
    return (float)(3.0 * GRID_PATCH_ERROR_MM / GRID_PATCH_FAR) / grid->reach;
}

#endif
