/*
 * Straight motion by digital integration, as controllers without fast multiplication did it.
 *
 * Machine units: a unit of velocity is a unit of position per cycle, so the integral is an
 * addition,
 *
 *     V(j+1) = V(j) + a,   S(j+1) = S(j) + V(j+1)
 *
 * in whole words. Euler's rule keeps a line straight, because all axes err in proportion; what is
 * lost is lost by truncation. Source: seed 002, part B.
 */
#ifndef TAKT_CLASSIC_INTEGRATE_H
#define TAKT_CLASSIC_INTEGRATE_H

#include "base/point.h"

#include <stdbool.h>
#include <stdint.h>

/*
 * The last N = 2^k cycles of a block share what is left of it, by a shift: k where nothing else is
 * said.
 */
#define INTEGRATE_END_SHIFT 4

struct integrate {
    double unit_mm;               /* of position, and per cycle of velocity */
    double ratio[AXIS_COUNT];     /* of each axis's way to the path */
    int64_t position[AXIS_COUNT]; /* units */
    int64_t velocity[AXIS_COUNT]; /* units per cycle */
    int64_t end[AXIS_COUNT];      /* units */
    /* most that truncation can have taken from a velocity, and from a position */
    double velocity_loss_ulp;
    double loss_ulp;
};

/* A line at rest at its start. Positions count from there. length_mm > 0: of the path. */
void takt_integrate_begin(struct integrate *i, double unit_mm, const struct point *start,
                          const struct point *end, double length_mm);

/* V += a: change of the path's way per cycle. */
void takt_integrate_accelerate(struct integrate *i, double change_mm);
/* V is set to its exact value, but for the last bit: at the end of an acceleration. */
void takt_integrate_set_velocity(struct integrate *i, double way_mm);
/*
 * V = way left / cycles: the end rule. What the division drops, less than a unit a cycle, is left
 * for the exact end.
 */
void takt_integrate_aim(struct integrate *i, double cycles);
/* S += V */
void takt_integrate_advance(struct integrate *i);
/* S is set to the exact end. */
void takt_integrate_land(struct integrate *i);

/* Distance from the start along every axis, mm. */
void takt_integrate_get_way(const struct integrate *i, struct point *way);

#endif
