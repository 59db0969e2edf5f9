/*
 * Shared by the sources of this room.
 */
#ifndef TAKT_STEP_STEPS_PRIVATE_H
#define TAKT_STEP_STEPS_PRIVATE_H

#include "step/steps.h"

/* A part of the cycle that begins, 0 ... 1. */
struct steps_span {
    double from, to;
};

static inline bool steps_has(const struct steps *s, unsigned axis)
{
    return (s->config.axes >> axis & 1U) != 0U;
}

/*
 * Hands a tick to the port, at a part of the cycle; later, if the one before or the rate of a drive
 * wants it. False: that is after the end of the cycle; it is the first of the next one, and no
 * other may follow.
 */
bool takt_steps_emit(struct steps *s, const struct step_port *port, double part,
                     const struct evaluate_tick *tick);

/* The even form: from one point to another. Leaves every axis at the nearest position to `to`. */
void takt_steps_even(struct steps *s, const struct step_port *port, const struct point *from,
                     const struct point *to, struct steps_span span);

/*
 * Takes up the path of a target: false, and no path is active, when its curve is not for evaluation
 * functions. The axes must be at the nearest positions to its start.
 */
bool takt_steps_path_begin(struct steps *s, const struct steps_target *target);

/*
 * Where on the path's curve a point is, 0 ... 1, from the part already done on; -1: it is not on
 * it.
 */
double takt_steps_path_place(const struct steps *s, const struct point *p);

/* All ticks due until that part of the curve. */
void takt_steps_path_follow(struct steps *s, const struct step_port *port, double part,
                            struct steps_span span);

#endif
