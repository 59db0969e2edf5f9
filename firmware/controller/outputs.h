/*
 * What events of a program do to the machine's outputs.
 *
 * Motion passes moves that are no motion between two of its setpoints; each is applied when it is
 * passed. A constant surface speed (G96) goes on changing the spindle's speed from then on, cycle
 * by cycle.
 */
#ifndef TAKT_CONTROLLER_OUTPUTS_H
#define TAKT_CONTROLLER_OUTPUTS_H

#include "base/point.h"
#include "hal/outputs.h"
#include "program/move.h"

/* A surface speed that the spindle keeps. All 0: none. */
struct outputs_surface {
    double mm_s;        /* > 0 */
    double axis_x_mm;   /* machine X of the spindle's axis */
    double highest_rpm; /* 0: any */
    double sense;       /* 1 clockwise, -1 counter-clockwise */
};

/* An event has been passed. Motions and events without outputs change nothing. */
void takt_outputs_apply(struct outputs *o, struct outputs_surface *surface, const struct move *m);

/*
 * Every control cycle: the spindle's speed that belongs to the setpoint, while a surface speed is
 * kept.
 */
void takt_outputs_keep_surface(struct outputs *o, const struct outputs_surface *surface,
                               const struct point *setpoint);
static inline void outputs_follow(struct outputs *o, const struct outputs_surface *surface,
                                  const struct point *setpoint)
{
    if (surface->mm_s > 0.0) {
        takt_outputs_keep_surface(o, surface, setpoint);
    }
}

#endif
