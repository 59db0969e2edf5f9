/*
 * Runs side by side as one SVG: the path of each, and feed, acceleration and jerk over time, and
 * what is removed over turns, on common scales.
 */
#ifndef TAKT_BORE_PICTURE_H
#define TAKT_BORE_PICTURE_H

#include "bore/removal.h"
#include "bore/track.h"

#include <stdio.h>

struct bore_picture {
    const struct bore_track *track;
    const struct bore_removal *removal; /* of each track */
    double turns;                       /* of the spirals, without the circle */
    unsigned tracks;                    /* columns, >= 1 */
    double radius_mm;                   /* of the circle: the scale of the paths */
    struct bore_motion limit;           /* of the machine's axes; drawn as lines */
};

void bore_picture_write(FILE *file, const struct bore_picture *picture);

#endif
