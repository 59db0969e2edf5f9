/*
 * What a machine file says of correction: constants. Tables come beside it (tables.h).
 *
 * Four coordinates have matrices: X, Y, Z and one rotary axis, psi, that turns the part. Lengths
 * mm, angles rad. All 0 is no correction.
 */
#ifndef TAKT_CORRECTION_SETTINGS_H
#define TAKT_CORRECTION_SETTINGS_H

#include "base/point.h"
#include "program/move.h"

#include <stdint.h>

#define CORRECTION_COORDINATES 4

/* The set-up as numbers in this order: offset X Y Z, turns about X Y Z, turn of psi. */
#define CORRECTION_SETUP_VALUES MOVE_SETUP_VALUES

struct correction_settings {
    /*
     * K = machine U + workpiece (U - W) + overhang T: U commanded, W the part's zero, T the tool's
     * offset from the spindle
     */
    double machine[CORRECTION_COORDINATES][CORRECTION_COORDINATES];
    double workpiece[CORRECTION_COORDINATES][CORRECTION_COORDINATES];
    double overhang[CORRECTION_COORDINATES][AXIS_LINEAR_COUNT];

    /*
     * The part stands displaced by offset and turned about pivot: about X first, then Y, then Z.
     * All of it turns with the table (turn_axis): pivot is a point of its axis then, and the set-up
     * is told with psi = 0.
     */
    double setup_offset_mm[AXIS_LINEAR_COUNT];
    double setup_rotation_rad[AXIS_LINEAR_COUNT];
    double setup_pivot_mm[AXIS_LINEAR_COUNT];
    double setup_turn_rad; /* turn of psi */

    double thermal_per_k[AXIS_LINEAR_COUNT];        /* growth: mm per mm and K */
    double thermal_reference_mm[AXIS_LINEAR_COUNT]; /* where nothing moves */

    /* What the tool loses along its axis and across it, per length and per time of cutting. */
    double wear_along_per_mm, wear_along_mm_s;
    double wear_across_per_mm, wear_across_mm_s;
    double tool_direction
        [AXIS_LINEAR_COUNT]; /* from the tool's point into its spindle, of any length; head at 0 */

    double largest_mm;      /* |K| of tables: the most that is accepted */
    double steepest_ratio;  /* likewise their slope */
    double fade_s;          /* layers and slow inputs: until 99 % of a change are done */
    double reversal_fade_s; /* likewise directions of approach */
    /* part of the axes' limits kept free at least, for tables loaded later: 0 ... 0.5 */
    double reserve_ratio;
    uint32_t turn_axis; /* enum axis: psi; AXIS_COUNT: none */
    uint32_t head_axis; /* enum axis: turns the tool, right-handed; AXIS_COUNT: none */
    uint32_t off;       /* bit i set: layer i is off until somebody switches it on */
};

/*
 * No correction, the tool along Z; 1 mm and 5 um/mm as the most a table may ask, fades of 1 s and
 * 0.25 s.
 */
void takt_correction_settings_set_default(struct correction_settings *settings);

#endif
