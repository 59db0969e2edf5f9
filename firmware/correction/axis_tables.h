/*
 * Tables over one axis, ready for the control cycle: cubic splines through their points, which need
 * not be evenly spaced. Pitch corrects the axis itself, straightness and squareness another one;
 * what differs with the direction of approach is backlash.
 */
#ifndef TAKT_CORRECTION_AXIS_TABLES_H
#define TAKT_CORRECTION_AXIS_TABLES_H

#include "base/error.h"
#include "correction/need.h"
#include "correction/table.h"

#include <stdbool.h>
#include <stdint.h>

/* Pairs of axes (input, corrected), and points of all of them together. */
#define AXIS_TABLES_PAIRS_MAX 18
#ifndef AXIS_TABLES_POINTS_MAX
#define AXIS_TABLES_POINTS_MAX 1024
#endif

/*
 * From one point to the next: c[0] + t (c[1] + t (c[2] + t c[3])), t the distance from the point.
 */
struct axis_piece {
    float mean[4];
    float half[4]; /* half the difference of the directions: up minus down */
};

struct axis_pair {
    uint8_t input, corrected; /* enum axis */
    bool directed;            /* half is not 0 everywhere */
    uint16_t first, points;   /* in the pool */
};

struct axis_tables {
    unsigned count;
    unsigned inputs; /* bit i: axis i is the input of a pair with directions */
    uint32_t points;
    struct axis_pair pair[AXIS_TABLES_PAIRS_MAX];
    /* Own, or where they are stored; a piece begins at its knot. */
    const double *knot_mm;
    const struct axis_piece *piece;
    double own_knot_mm[AXIS_TABLES_POINTS_MAX];
    struct axis_piece own_piece[AXIS_TABLES_POINTS_MAX];
};

/*
 * Adds a table over one axis, which has passed takt_table_check; tables must not be moved
 * afterwards. False: *wrong says why, and nothing has changed.
 */
bool takt_axis_tables_add(struct axis_tables *tables, const struct table *table,
                          struct diagnostic *wrong);

/*
 * Adds weight times the corrections at a point to k, by axis. approach: of each axis, 1 when it
 * comes from below, -1 from above, between them while one fades into the other. Returns the inputs
 * that are outside: bit i for axis i.
 */
unsigned takt_axis_tables_sum(const struct axis_tables *tables, const struct point *at,
                              const float approach[AXIS_COUNT], float weight, float k[AXIS_COUNT]);

/* A number between -1 and 1 that fades: the most it does. */
struct approach_bound {
    double velocity_per_s, acceleration_per_s2, jerk_per_s3;
};

void takt_axis_tables_need(const struct axis_tables *tables, const struct approach_bound *approach,
                           const struct motion_bound *most, struct need *need);

#endif
