/*
 * Circular motion: G2, G3, their centre from I J K or R.
 */
#ifndef TAKT_PROGRAM_CIRCULAR_H
#define TAKT_PROGRAM_CIRCULAR_H

#include "program/program.h"

/*
 * For involutes too: the centre from its words, machine coordinates; how far a point may be off the
 * curve; what must hold of the plane and its words. False: p->error is set.
 */
bool takt_circular_centre(struct program *p, enum axis first, enum axis second,
                          double centre_mm[2]);
double takt_circular_slack_mm(const struct program *p);
bool takt_circular_check_plane(struct program *p, enum axis first, enum axis second);

/*
 * Of splines too: the machine has the axes of the plane, which is not turned out of them by a
 * rotated system, and no compensation has just ended.
 */
bool takt_circular_check_axes(struct program *p, enum axis first, enum axis second);

/* G2, G3; argument: MOVE_ARC_CW or MOVE_ARC_CCW */
/* The centre of the line's arc to end, in the axes of the plane. False: p->error is set. */
bool takt_circular_find_centre(struct program *p, const struct program_code *code,
                               const struct point *end, double centre_mm[2]);

bool takt_circular_move(struct program *p, const struct program_code *code);

#endif
