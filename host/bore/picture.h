/*
 * Runs side by side as one SVG: the path of each, and feed, acceleration and jerk over time on common scales.
 */
#ifndef TAKT_BORE_PICTURE_H
#define TAKT_BORE_PICTURE_H

#include "bore/track.h"

#include <stdio.h>

struct bore_picture {
    const struct bore_track *track;
    unsigned tracks;          /* columns, >= 1 */
    double radius_mm;         /* of the circle: the scale of the paths */
    struct bore_motion limit; /* of the machine's axes; drawn as lines */
};

void bore_picture_write(FILE *file, const struct bore_picture *picture);

#endif
