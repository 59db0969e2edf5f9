/*
 * The machine as it really is: where the tool's point comes to when the drives stand where they
 * stand.
 *
 * Three linear axes and a turning table, if there is one, stand on one another as the chain says.
 * Each of them has the six errors of a rigid body that is guided (ISO 230-1: E_XX ... E_CX), and
 * there are three squarenesses: 21 errors of the linear axes, as functions of position. Besides:
 * growth with temperature, backlash, the yaw of the table, and wear of the tool. Nothing of this is
 * known to the controller.
 */
#ifndef TAKT_DEVIATION_DEVIATION_H
#define TAKT_DEVIATION_DEVIATION_H

#include "base/point.h"
#include "base/unit_chain.h"
#include "deviation/deviation_curve.h"

#include <stdbool.h>
#include <stdint.h>

#define DEVIATION_LINEAR 3

/* Units with errors: X, Y, Z, and the table. */
#define DEVIATION_TABLE DEVIATION_LINEAR
#define DEVIATION_UNITS (DEVIATION_TABLE + 1)

/* Errors of a guided axis: translations along X, Y, Z (um), rotations about them (urad). */
#define DEVIATION_OF_AXIS 6

struct deviation_config {
    struct unit_chain chain; /* units 0: Z on Y on X on the bed, a turning table on the bed too */
    double axis[DEVIATION_UNITS][DEVIATION_OF_AXIS][DEVIATION_CURVE_NUMBERS];
    double squareness_urad
        [3]; /* of Y to X about Z (C0Y), of Z to X about Y (B0Z), of Z to Y about X (A0Z) */
    double tool_mm
        [DEVIATION_LINEAR]; /* from the spindle's nose to the tool's point, the arm of rotations */
    double tool_direction
        [DEVIATION_LINEAR]; /* from its point into the spindle, of any length, with the head at 0 */
    uint32_t head_axis;     /* AXIS_A ... AXIS_C: turns the tool about X ... Z; AXIS_COUNT: none */
    double backlash_um[DEVIATION_LINEAR];

    uint32_t table_axis; /* AXIS_A ... AXIS_C: turns the part about X ... Z; AXIS_COUNT: none */
    double
        table_yaw[DEVIATION_CURVE_NUMBERS]; /* urad over the turn; its wavelength is in degrees */
    double table_centre_mm[DEVIATION_LINEAR];

    double growth_um_per_m_k[DEVIATION_LINEAR];
    double growth_reference_mm[DEVIATION_LINEAR];
    double warming_k;      /* in the end */
    double warming_time_s; /* time constant; 0: warm from the start */
    double sensor_step_k;  /* resolution of the temperature sensor; 0: exact */

    double wear_along_um_per_m, wear_along_um_per_min; /* of cutting; along the tool */
};

struct deviation {
    struct deviation_config config;
    double min_mm[AXIS_COUNT], max_mm[AXIS_COUNT]; /* travel */
    double drives_mm[DEVIATION_LINEAR];            /* where the drives were last */
    double
        lost_mm[DEVIATION_LINEAR]; /* play between drive and table: where in the gap the table is */
    double rise_k;
    double wear_mm; /* the tool is so much shorter */
    bool any;       /* there is any error at all */
};

void deviation_init(struct deviation *d, const struct deviation_config *config,
                    const double min_mm[AXIS_COUNT], const double max_mm[AXIS_COUNT]);

/* The drives have moved, time_s after the start: play is taken up, the machine warms. */
void deviation_follow(struct deviation *d, const struct point *drives, double time_s);

/* The tool has cut so far, for so long, in all. */
void deviation_set_wear(struct deviation *d, double length_mm, double time_s);

/* What the temperature sensor says. */
double deviation_sensor_k(const struct deviation *d);

/*
 * Where the tool's point is when the drives stand there, X Y Z mm. With a turning table: where on
 * the part it is, given as the place a perfect machine would be sent to for it, with its table at
 * turn_rad.
 */
void deviation_tool_point(const struct deviation *d, const struct point *drives, double turn_rad,
                          struct point *tool);

/*
 * The six errors of a unit as an instrument finds them that looks at this unit alone: how far it is
 * from its place (mm) and direction (rad), in machine axes, when it is wanted at at_mm. Squareness,
 * play and growth are among its shifts.
 */
void deviation_unit(const struct deviation *d, unsigned axis, const struct point *drives,
                    double at_mm, double errors[DEVIATION_OF_AXIS]);

/* The table's angle: rad. */
double deviation_table_angle(const struct deviation *d, const struct point *drives);

#endif
