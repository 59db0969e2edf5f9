/*
 * Merges lines that are nearly one (G64 Q): short lines of a programmed curve come closer together
 * than their number of digits can tell, and a few long elements let the smoother look farther ahead
 * than many short ones.
 */
#ifndef TAKT_SMOOTH_MERGE_H
#define TAKT_SMOOTH_MERGE_H

#include "geometry/curve.h"
#include "program/move.h"
#include "smooth/limits.h"

#include <stdbool.h>
#include <stdint.h>

/* Ends of lines that one merged line may pass over. */
#define MERGE_POINTS_MAX 24

/* A line that may still grow. */
struct merge {
    struct move move; /* the last one that is part of it */
    uint32_t number;  /* of that motion */
    struct curve curve;
    unsigned lines;                       /* that it is of; 0: there is none */
    struct point point[MERGE_POINTS_MAX]; /* programmed ends it passes over, between them */
};

void takt_merge_open(struct merge *m, const struct move *move, uint32_t number,
                     const struct curve *curve);
/*
 * True when the line now reaches to the end of this motion, passing every programmed end within
 * within_mm.
 */
bool takt_merge_take(struct merge *m, const struct move *move, uint32_t number,
                     const struct curve *curve, double within_mm);

#endif
