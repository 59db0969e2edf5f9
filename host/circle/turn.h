/*
 * One measured turn of a circle: how far the tool is from it, over the angle (ISO 230-4).
 */
#ifndef TAKT_HOST_CIRCLE_TURN_H
#define TAKT_HOST_CIRCLE_TURN_H

#include <stdbool.h>
#include <stddef.h>

/*
 * A place of the tool: its angle, 0 ... 2 pi from the plane's first axis to its second, and how far
 * outside of the circle it is.
 */
struct circle_place {
    double angle_rad, out_mm;
};

/* All zero at first. */
struct circle_turn {
    double radius_mm;           /* of the circle */
    struct circle_place *place; /* one for each cycle; owned */
    size_t count, capacity;
    bool failed; /* out of memory */
};

/* The tool is there, from the centre. */
void circle_turn_add(struct circle_turn *turn, const double from_centre_mm[2]);
void circle_turn_free(struct circle_turn *turn);

#endif
