/*
 * Goal: no fault of planning leaves a program running without end.
 *
 * With c the feed ceiling of a block under the present overrides, a the acceleration of the
 * trapezoidal reference in it, W the cycles that the averages reach over, a block of length L is
 * explained to take
 *
 *     T = L / c + 2 c / a + 4 W + WATCH_EVERY_CYCLES      cycles
 *
 * at its feed; up to speed and down again; a wait for the window at both ends, and before it may
 * brake or speed up; blocks behind it that come into view, and ceilings that are taken. Where the
 * trapezoidal reference may move for so long that these parts of T add up to WATCH_PARTS in one
 * block, an alarm ends the program.
 *
 * It may not move while the operator holds, an override is 0, the program waits, the spindle of a
 * feed per revolution stands, or no path is known ahead of it: a late background is no standstill.
 */
#ifndef TAKT_MOTION_WATCH_H
#define TAKT_MOTION_WATCH_H

#include <stdbool.h>
#include <stdint.h>

/*
 * In 10,000 random programs, with axes up to 100 apart, no block takes more than 5 under random
 * overrides.
 */
#define WATCH_PARTS 16.0F

/* Four exchanges with the background. */
#define WATCH_EVERY_CYCLES 64

struct watch {
    uint32_t block; /* the path's: the oldest one, */
    float parts;    /* and so much of what it is explained to take has gone by */
    uint32_t line;  /* of the program; 0: nothing has stalled */
};

struct motion;

/*
 * A look every WATCH_EVERY_CYCLES. may_move: nothing keeps the axes where they are. False: for too
 * long.
 */
bool takt_watch_look(struct motion *m, bool may_move);

#endif
