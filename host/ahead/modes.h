/*
 * The machine's modes in the optimiser's curve: what the motors and the tool do when the curve is
 * w.
 *
 * A mode of an axis (host/vibration) of frequency w_0 and damping ratio d leaves the tool off the
 * motor's place q by part e,
 *
 *     e" + 2 d w_0 e' + w_0^2 e = -q"
 *
 * Both follow from one curve w, the flat output, by derivatives alone (Fliess, Levine, Martin,
 * Rouchon 1995):
 *
 *     q = w + 2 d / w_0 w' + w" / w_0^2        e = -w" / w_0^2
 *
 * so that rows for limits (of q) and tolerance (of q + part e) stay local, and where w rests,
 * nothing swings. For control points h apart it is exact with the recursion of the free oscillator,
 * e_(j+1) - t e_j + p e_(j-1) = 0 (trace and determinant of its step): with D = S - t + p / S, S
 * the shift by a knot,
 *
 *     q_j = (D w)_j / D(1) = w_j + slope w'_j + bend w"_j,    w' = (w_(j+1) - w_(j-1)) / 2,  w" = w_(j+1) - 2 w_j + w_(j-1)
 *     slope = (1 - p) / D(1)      bend = (1 + p) / (2 D(1))      D(1) = 1 - t + p
 *
 * swings freely never, and e_j = -w"_j / (w_0 h)^2 up to fourth differences of w over 240. With two
 * modes D = D_1 D_2, and each mode's own w is the other's D of w.
 */
#ifndef TAKT_HOST_AHEAD_MODES_H
#define TAKT_HOST_AHEAD_MODES_H

#include "convex/problem.h"
#include "vibration/vibration.h"

#include <stddef.h>

#define MODES_MAX PROBLEM_MODES_MAX
_Static_assert(VIBRATION_MODES <= MODES_MAX, "every mode of an axis is planned for");

/* Control points of w, around one of the motor's, that decide it. */
#define MODES_REACH_MAX PROBLEM_REACH_MAX

struct modes_stage {
    double slope, bend;
    double away; /* part e_j = away w"_j */
};

/* Machines whose modes are slower or faster than planned for, as far as they may be. */
#define MODES_STRAYS PROBLEM_STRAYS

/*
 * How such a machine's tool swings about the motors' control points q: with u = q + E its own,
 *
 *     E_(j+1) - trace E_j + determinant E_(j-1) + pull (q_(j+1) - 2 q_j + q_(j-1)) = 0
 *
 * the recursion of its free oscillator, pull such that at an even acceleration E is -part
 * q" / w_1^2.
 */
struct modes_stray {
    double trace, determinant, pull;
    double part;
    double drag; /* d w_1 h */
};

struct ahead_modes {
    unsigned strays; /* that are planned for: 0 or MODES_STRAYS */
    struct modes_stray stray[MODES_STRAYS][AXIS_LINEAR_COUNT];
    /* knots in which each of them shows how far it swings: half a period of the slowest */
    size_t rest;
    unsigned count; /* of the axis that has most; 0: the machine is stiff */
    /* of what the tool is off the motors: so much may setpoints in place of a curve change it */
    double lag;
    struct modes_stage stage[AXIS_LINEAR_COUNT][MODES_MAX]; /* 0: none */
};

/*
 * A control point of an axis and how it changes, to first order, with w and with e, the square of
 * the rate less 1, at the 1 + 2 count points of w around it: w' is w' (1 + e / 2) then, and w" is
 * w" (1 + e) + w' e' / 2.
 */
struct modes_point {
    double at_mm;
    double by_curve[MODES_REACH_MAX];
    double by_time[MODES_REACH_MAX];
};

/* config has passed its check; setpoints are cycle_s apart. */
void modes_init(struct ahead_modes *modes, const struct vibration_config *config, double step_s,
                double cycle_s);

/* The motors' point and the tool's, in the middle of the 1 + 2 count points of w. */
void modes_at(const struct ahead_modes *modes, int axis, double (*w)[3], struct modes_point *motor,
              struct modes_point *tool);

/*
 * The greatest time between knots for which the above holds: an oscillation's radian. Infinite:
 * there is no mode.
 */
double modes_step_s(const struct vibration_config *config);

#endif
