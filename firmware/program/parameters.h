/*
 * Numbered parameters #1 ... #PARAMETER_NUMBER_MAX. One that was never set is 0.
 *
 * A sparse store of fixed size: #1 ... #30 are an array, the rest is a list sorted by number, so
 * looking one up takes about ten comparisons and listing them goes in order. The caller owns it; it
 * outlives a program (work offsets, reference positions). Values are as part programs see them: mm
 * and degrees for offsets.
 */
#ifndef TAKT_PROGRAM_PARAMETERS_H
#define TAKT_PROGRAM_PARAMETERS_H

#include "program/program_limits.h"

#include <stdbool.h>
#include <stdint.h>

/* Numbers with a meaning; those of axes are the first of six: X Y Z A B C. */
#define PARAMETER_PROBE         5061 /* G38: where the probe answered, in work coordinates */
#define PARAMETER_PROBE_CONTACT 5070 /* 1: the last G38 ended by the probe's answer */
#define PARAMETER_REFERENCE_1   5161 /* G28: machine position */
#define PARAMETER_REFERENCE_2   5181 /* G30: machine position */
#define PARAMETER_AXIS_APPLIED  5210 /* 1 while the offsets of G92 are in effect */
#define PARAMETER_AXIS_OFFSET   5211 /* G92 */
#define PARAMETER_SYSTEM        5220 /* selected coordinate system: 1 (G54) ... 9 (G59.3) */
#define PARAMETER_SYSTEM_OFFSET 5221 /* G54; PARAMETER_SYSTEM_STRIDE further for each next system */
#define PARAMETER_SYSTEM_ROTATE 5230 /* G54: rotation about Z, degrees; stride as above */
#define PARAMETER_SYSTEM_STRIDE 20
#define PARAMETER_INPUT         5399 /* what M66 read */
#define PARAMETER_TOOL_NUMBER   5400 /* tool in the spindle; computed, as are the others of it */
#define PARAMETER_TOOL_OFFSET   5401 /* its length offsets, six axes */
#define PARAMETER_TOOL_DIAMETER 5410
#define PARAMETER_TOOL_FRONT    5411 /* angle, degrees */
#define PARAMETER_TOOL_BACK     5412
#define PARAMETER_TOOL_SIDE     5413 /* orientation: 0 to 9 */
#define PARAMETER_POSITION      5420 /* work coordinates in the program's units, six axes */

struct parameters {
    double local[PARAMETERS_LOCAL];
    uint16_t count;                  /* of the two below */
    uint16_t number[PARAMETERS_MAX]; /* rising */
    double value[PARAMETERS_MAX];
};

/* All parameters 0. */
void takt_parameters_clear(struct parameters *p);

/* 0 for a number that was never set. number: 1 ... PARAMETER_NUMBER_MAX. */
double takt_parameters_get(const struct parameters *p, unsigned number);

/* False when there is no room. Setting 0 never needs room. */
bool takt_parameters_set(struct parameters *p, unsigned number, double value);

/*
 * The next parameter after *number that is not 0, for saving: true, *number and *value; start with
 * *number = 0.
 */
bool takt_parameters_next(const struct parameters *p, unsigned *number, double *value);

#endif
