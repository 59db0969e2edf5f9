/*
 * The errors of a machine, composed of those of its units along their chain.
 *
 * Each unit is a rigid body that is off its place by three shifts and off its direction by three
 * small turns, all of them tables over its own position. A shift moves what stands on the unit; a
 * turn moves it by as much as it is far away, so the same table of a lower unit corrects
 * differently at each place of the machine.
 */
#ifndef TAKT_CORRECTION_GEOMETRY_H
#define TAKT_CORRECTION_GEOMETRY_H

#include "base/error.h"
#include "base/point.h"
#include "base/unit_chain.h"
#include "correction/axis_tables.h"
#include "correction/need.h"
#include "correction/table.h"

#include <stdbool.h>

struct geometry {
    struct unit_chain chain;
    double tool_mm[AXIS_LINEAR_COUNT];   /* from the point that X Y Z tell of to the tool's point */
    double centre_mm[AXIS_LINEAR_COUNT]; /* a point of the turning unit's axis, as X Y Z */
    /*
     * of Y to X about Z (C0Y), of Z to X about Y (B0Z), of Z to Y about X (A0Z): as ISO 230-1 has
     * them
     */
    double squareness_rad[AXIS_LINEAR_COUNT];
    struct axis_tables errors[UNIT_CHAIN_MAX]; /* of each unit; count 0: it has none */
    /*
     * Those below, by takt_geometry_init: an image in which no machine has errors of units is
     * without their code.
     */
    unsigned (*take_back)(const struct geometry *g, const struct point *at, double weight,
                          unsigned axes_end, float k[AXIS_COUNT]);
    void (*need)(const struct geometry *g, const struct motion_bound *most, struct need *need);
};

/* No errors yet; whatever else it holds is for the caller to set. */
void takt_geometry_init(struct geometry *g);

/*
 * Takes a table of a unit's errors (E columns). The chain is set; *g must not be moved. False:
 * *wrong says why.
 */
bool takt_geometry_add(struct geometry *g, const struct table *table, struct diagnostic *wrong);

/*
 * How far the tool's point is off the commanded place, as seen from the part with its table where
 * it is commanded; and how far the turning unit is off. Returns the inputs that are outside of
 * their tables: bit i for axis i.
 */
unsigned takt_geometry_deviation(const struct geometry *g, const struct point *at,
                                 double deviation[AXIS_COUNT]);

/*
 * Takes these deviations, by weight, from the corrections of the axes before axes_end. Returns the
 * same.
 */
unsigned takt_geometry_take_back(const struct geometry *g, const struct point *at, double weight,
                                 unsigned axes_end, float k[AXIS_COUNT]);

/* Adds what taking these deviations back takes of the axes. */
void takt_geometry_need(const struct geometry *g, const struct motion_bound *most,
                        struct need *need);

#endif
