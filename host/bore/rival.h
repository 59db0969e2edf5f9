/*
 * Ways to spiral out to a circle that hole milling by involutes is compared with (seed 001). Each
 * begins at the centre, makes n turns, a helix one, and then the circle of radius R about it, all
 * counter-clockwise.
 */
#ifndef TAKT_BORE_RIVAL_H
#define TAKT_BORE_RIVAL_H

#include "bore/path.h"

enum bore_rival {
    BORE_RIVAL_INVOLUTE,
    BORE_RIVAL_TWO_POLES,  /* half circles about two poles in turn */
    BORE_RIVAL_FOUR_POLES, /* quarter circles about the corners of a square */
    BORE_RIVAL_ARCHIMEDES, /* radius in proportion to the angle, as arcs within a tolerance */
    BORE_RIVAL_HELIX,      /* a half circle out above the work, and a turn down */
    BORE_RIVALS
};

const char *bore_rival_name(enum bore_rival rival);

/* down_mm: of the helix. bore_path_free is due; look at failed. */
void bore_rival_path(enum bore_rival rival, double radius_mm, unsigned turns, double tolerance_mm,
                     double down_mm, struct bore_path *p);

#endif
