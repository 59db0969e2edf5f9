/*
 * A curve as arcs or lines, for controllers that do not know it.
 */
#ifndef TAKT_BORE_APPROXIMATE_H
#define TAKT_BORE_APPROXIMATE_H

#include "bore/path.h"

/*
 * A curve that turns left all the way, with a parameter that grows along it by at most its heading.
 */
struct bore_curve {
    const void *context;
    /* point in mm and direction, of length 1 */
    void (*at)(const void *context, double parameter, double point_mm[2], double direction[2]);
};

/*
 * Pairs of arcs that begin and end in the curve's points and directions; the path ends at the
 * curve's start.
 */
void bore_approximate_arcs(struct bore_path *p, const struct bore_curve *c, double from, double to,
                           double tolerance_mm);

/* Lines from point to point of the curve. */
void bore_approximate_lines(struct bore_path *p, const struct bore_curve *c, double from, double to,
                            double tolerance_mm);

#endif
