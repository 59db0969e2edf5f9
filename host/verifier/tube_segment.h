/*
 * Straight pieces of a path, and where a setpoint is beside one.
 */
#ifndef TAKT_HOST_TUBE_SEGMENT_H
#define TAKT_HOST_TUBE_SEGMENT_H

#include "base/point.h"

/* From start to start + way, over all axes; a radian counts as a millimetre. */
struct tube_segment {
    struct point start, way;
    double length_mm; /* may be 0 */
    double square_mm2;
};

/* Where a setpoint is beside a piece. */
struct tube_beside {
    double part;        /* of the piece, 0 ... 1 */
    double distance_mm; /* from there */
    double first;       /* the first part of it that is within reach; > 1: none */
    double last;
};

/*
 * The place of a segment nearest to p that is not before the part `from`, and all places within so
 * much of p.
 */
struct tube_beside tube_segment_beside(const struct tube_segment *s, double from,
                                       const struct point *p, double within_mm);

struct point tube_segment_end(const struct tube_segment *s);

#endif
