/*
 * Setpoints on a smoothed curve that are moved by a hold (hold.h) in place of the trapezoidal
 * reference and its averages.
 */
#ifndef TAKT_MOTION_HELD_H
#define TAKT_MOTION_HELD_H

#include "motion/motion.h"

#include <stdbool.h>

/*
 * One cycle, under the operator's hold or not. True: the setpoint has been moved by it, and the
 * trapezoidal reference follows. It takes over when a hold begins on a smoothed curve and it can
 * brake there, and hands over when it cannot go on by itself, or is up to speed again.
 */
bool takt_held_move(struct motion *m, bool hold);

/* The trapezoidal reference goes on from where the setpoint is. */
void takt_held_end(struct motion *m);

#endif
