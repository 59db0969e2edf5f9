/*
 * A path in the plane of the hole: pieces that follow each other, all counter-clockwise. Owned by
 * the caller, grows as needed.
 */
#ifndef TAKT_BORE_PATH_H
#define TAKT_BORE_PATH_H

#include "geometry/curve.h"

#include <stdbool.h>
#include <stddef.h>

enum bore_kind { BORE_LINE, BORE_ARC, BORE_INVOLUTE };

struct bore_piece {
    enum bore_kind kind;
    double to_mm[2];
    double centre_mm[2]; /* of an arc, or of an involute's base circle */
    double base_mm;      /* radius of an involute's base circle */
    double down_mm;      /* of an arc: so much lower at its end, a helix */
};

struct bore_path {
    double from_mm[2];
    struct bore_piece *piece;
    size_t count, capacity;
    bool failed; /* memory was short: the path is not complete */
};

void bore_path_begin(struct bore_path *p, const double from_mm[2]);
void bore_path_free(struct bore_path *p);
void bore_path_add(struct bore_path *p, const struct bore_piece *piece);
void bore_path_line(struct bore_path *p, double x_mm, double y_mm);
/* An arc from where the path ends; ending there too it is a full circle. */
void bore_path_arc(struct bore_path *p, const double to_mm[2], const double centre_mm[2]);

/* A full circle about the origin, so much lower at its end. */
void bore_path_helix(struct bore_path *p, double down_mm);

/* Where the piece begins; the end of the path is the beginning of piece number count. */
const double *bore_path_start(const struct bore_path *p, size_t piece);

/*
 * Adds the pieces from first to count backwards, as their mirror image in the line through the
 * origin and the path's end: a way out like the way in.
 */
void bore_path_add_mirrored(struct bore_path *p, size_t first, size_t count);

#endif
