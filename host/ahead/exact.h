/*
 * A section on the exact path, as the planner on board drives it with a control cycle of one knot:
 * legal, and the yardstick of the optimiser.
 *
 * Its setpoints are the control points: so differences of control points are differences of
 * setpoints, which keep every limit. The curve is off a setpoint by its second difference / 6, A
 * step^2 / 6 at most, and on a line not at all.
 */
#ifndef TAKT_HOST_AHEAD_EXACT_H
#define TAKT_HOST_AHEAD_EXACT_H

#include "ahead/path.h"
#include "ahead/trail.h"
#include "plan/limits.h"

/*
 * stops: at every junction, for a section where a junction that is passed breaks a limit. limits:
 * what may be used of the machine, cycle_s the time between knots. False: out of memory, or the
 * planner does not go on in a line, *stalled. The caller frees the trail.
 */
bool exact_trail(const struct ahead_path *path, const struct plan_limits *limits, bool stops,
                 struct trail *trail, uint32_t *stalled);

/* Do differences of control points keep the limits? */
bool exact_is_legal(const struct trail *trail, const struct plan_limits *limits);

/* No motion is faster: every element at its feed, or the axes' along it. */
double exact_least_s(const struct ahead_path *path, const struct plan_limits *limits);

#endif
