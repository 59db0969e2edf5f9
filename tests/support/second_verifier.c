#include "support/second_verifier.h"

#include "base/maths.h"
#include "bench/hunting/hunt_walk.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rounding of what is computed, as a part of the tolerance. */
#define ROOM 1e-6

/* Pieces looked at beside steps. */
#define WORK_MOST 400000000

static struct verifier j;

void second_begin(unsigned axes)
{
    free_case(&j);
    memset(&j, 0, sizeof(j));
    j.axes = axes;
    j.linear_axes = axes;
    j.work_most = WORK_MOST;
    memset(add_row(&j), 0, axes * sizeof(double));
}

/* In the arc's sense, up to a whole turn. */
static double sweep_of(const struct move *m, const double *start)
{
    const double from = atan2(start[1] - m->centre_mm[1], start[0] - m->centre_mm[0]);
    const double to = atan2(m->end.at[1] - m->centre_mm[1], m->end.at[0] - m->centre_mm[0]);
    const double turn = m->kind == MOVE_ARC_CCW ? to - from : from - to;
    const double sweep = turn < 0.0 ? turn + MATHS_TWO_PI : turn;

    return m->kind == MOVE_ARC_CCW ? sweep : -sweep;
}

void second_add_motion(const struct move *m)
{
    struct motion *next = add_motion(&j);

    next->tolerance_mm = m->tolerance_mm;
    memcpy(next->end, m->end.at, j.axes * sizeof(double));
    if (m->kind == MOVE_ARC_CW || m->kind == MOVE_ARC_CCW) {
        next->is_arc = true;
        next->second = 1;
        memcpy(next->centre, m->centre_mm, sizeof(next->centre));
        next->sweep_rad = sweep_of(m, next->start);
    }
    measure_motion(&j, next);
}

void second_add_setpoint(const struct point *p)
{
    memcpy(add_row(&j), p->at, j.axes * sizeof(double));
}

double second_order(bool ended)
{
    double factor = 1.0;
    struct walk w;

    if (j.motions == 0) {
        return factor;
    }
    cut(&j);
    measure_bends(&j);
    j.reach = make(j.pieces, sizeof(*j.reach));
    j.completed = !ended;
    w = walk_along(&j, 1.0 + ROOM, false, NULL);
    if (!w.arrived) {
        factor = ended ? MATHS_INFINITY : least_factor(&j);
    }
    free(j.reach);
    return factor;
}
