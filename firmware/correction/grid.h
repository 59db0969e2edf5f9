/*
 * A table over two to four axes, ready for the control cycle: the uniform cubic B-spline through
 * its points.
 *
 * Corrections are single precision, so that a processor with a single-precision unit evaluates them
 * in hardware. Position within a cell is reduced in double first. The four corrections are those of
 * X, Y, Z and one rotary axis.
 */
#ifndef TAKT_CORRECTION_GRID_H
#define TAKT_CORRECTION_GRID_H

#include "base/error.h"
#include "correction/need.h"
#include "correction/table.h"

#include <stdbool.h>
#include <stdint.h>

/* Components: corrections of X, Y, Z and the turning axis. */
#define GRID_COMPONENTS 4

/* Coefficients of all components: for a table of n points along an input there are n + 2. */
#ifndef GRID_COEFFICIENTS_MAX
#define GRID_COEFFICIENTS_MAX 16384
#endif

struct grid_input {
    uint8_t axis;       /* enum axis */
    uint16_t points;    /* 2 or more */
    uint32_t last_cell; /* points - 2 */
    size_t stride;      /* from one coefficient to the next along it */
    double first_mm;    /* position of the first point */
    double per_mm;      /* steps per mm or rad */
    double last;        /* position of the last point, in steps */
    float steps_per_mm; /* per_mm, for short ways */
    float mm_per_step;
};

/* Number of different derivatives up to the third order, by any of four inputs. */
#define GRID_ORDERS 35

struct grid {
    unsigned inputs;    /* 2 ... TABLE_INPUTS_MAX; 0: no table */
    uint8_t components; /* bit i set: component i corrects something */
    /* enum axis that component 3 corrects; AXIS_COUNT: none. The others are X, Y, Z */
    uint8_t turn_axis;
    size_t size;                               /* coefficients of one component */
    float bound[GRID_COMPONENTS][GRID_ORDERS]; /* of derivatives: grid_bound.h */
    /* For patches (grid_patch.h), which takt_grid_patch_set_pace sets. */
    float reach;   /* steps from where one is made to where it is good, all inputs together */
    float fastest; /* steps a cycle that they can follow, likewise */
    uint8_t ready; /* the stage in which one is ready */
    struct grid_input input[TABLE_INPUTS_MAX]; /* the first has stride 1 */
    const float *coefficient;         /* component by component: own, or where they are stored */
    float own[GRID_COEFFICIENTS_MAX]; /* of a spline that takt_grid_set has made */
};

/*
 * Makes the spline; grid must not be moved afterwards. table has passed takt_table_check. False: it
 * does not fit; *wrong says why.
 */
bool takt_grid_set(struct grid *grid, const struct table *table, struct diagnostic *wrong);

/*
 * Adds weight times the corrections at a point to k, by axis. Returns the inputs that are outside:
 * bit i for axis i.
 */
unsigned takt_grid_add(const struct grid *grid, const struct point *at, float weight,
                       float k[AXIS_COUNT]);

/* Adds what following the table takes of the axes, with commanded motion up to most. */
void takt_grid_need(const struct grid *grid, const struct motion_bound *most, double cycle_s,
                    struct need *need);

#endif
