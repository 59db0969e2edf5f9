/*
 * An arc of unit steps with any number of further axes that move in proportion to its angle: a
 * helix, over any octants. Radially, and on every straight axis, the error stays below one step;
 * and so does that along the arc.
 */
#ifndef TAKT_STEP_EVALUATE_HELIX_H
#define TAKT_STEP_EVALUATE_HELIX_H

#include "step/evaluate_arc.h"

#include <stdbool.h>

struct evaluate_helix {
    enum evaluate_form form;
    struct evaluate_arc arc;
    bool arc_done;
    unsigned plane[2];        /* the arc's axes */
    unsigned leading;         /* straight axis with the largest increment */
    uint8_t direction;        /* of the straight axes */
    int64_t size[AXIS_COUNT]; /* increments of the straight axes; 0 in the plane */
    int64_t done[AXIS_COUNT]; /* steps of them made */
    double due;               /* of the next tick */
};

/*
 * plane: the arc's axes, different ones. delta: increments in steps; those of the plane are the
 * arc's affair.
 */
void takt_evaluate_helix_begin(struct evaluate_helix *h, const struct evaluate_arc_config *arc,
                               const unsigned plane[2], const int64_t delta[AXIS_COUNT]);

/* The next tick. False: the end has been reached, *tick is empty. */
bool takt_evaluate_helix_next(struct evaluate_helix *h, struct evaluate_tick *tick);

/*
 * Which part of the way, 0 ... 1, has been done when the next tick is due, at constant speed
 * evenly. 1 at the end.
 */
double takt_evaluate_helix_due(const struct evaluate_helix *h);

#endif
