/*
 * A circular test as machine makers print it: both ways around one circle, deviations enlarged.
 */
#ifndef TAKT_HOST_CIRCLE_PICTURE_H
#define TAKT_HOST_CIRCLE_PICTURE_H

#include "circle/figures.h"

#include <stdio.h>

struct circle_picture {
    char axis[2]; /* of the plane: its letters, first and second */
    double radius_mm, feed_mm_min;
    const struct circle_turn *turn;       /* CIRCLE_WAYS of them */
    const struct circle_figures *figures; /* likewise, and behind them those of both ways */
};

/* An SVG file. */
void circle_picture_write(FILE *file, const struct circle_picture *picture);

#endif
