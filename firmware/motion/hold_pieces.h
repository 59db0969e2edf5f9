/*
 * The curve ahead of a setpoint that a hold moves (hold.h), in pieces of one length: of a smoothed
 * curve those that the path has, of an arc parts of its block.
 */
#ifndef TAKT_MOTION_HOLD_PIECES_H
#define TAKT_MOTION_HOLD_PIECES_H

#include "motion/hold.h"

#include <stdbool.h>
#include <stdint.h>

/*
 * The pieces from the setpoint on, which is `at` path units behind the start of the path's first
 * block and has gone `way` in the last cycle; those that are known stay. False: no hold is made for
 * what it is on.
 */
bool takt_hold_look(struct hold *h, struct path *path, double at, double way);

/* Do the axes stand on all of the path's first block, as a smoothed curve does at its ends? */
bool takt_hold_stands(const struct path *path);

/* A few more of them, as one cycle has time for. */
void takt_hold_read(struct hold *h, struct path *path);

/* Where the setpoint's piece starts on the path. */
uint64_t takt_hold_start(const struct hold *h, const struct path *path);

/* The highest rate on a piece, whatever the overrides are: pieces a cycle. */
float takt_hold_top(const struct hold *h, const struct path *path, uint32_t piece);

/* Does the curve end before a piece? */
bool takt_hold_is_behind(const struct hold *h, const struct path *path, uint32_t piece);

#endif
