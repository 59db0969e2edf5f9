/* Inside motion: how the cycle comes to ceilings. */
#ifndef TAKT_MOTION_EXCHANGE_H
#define TAKT_MOTION_EXCHANGE_H

#include "motion/motion.h"

/*
 * In every cycle: takes a ceiling that has been built, and asks for another one every
 * MOTION_EXCHANGE_CYCLES. While a ceiling is being taken none is free to be made: then a new one is
 * asked for some cycles later.
 */
void takt_motion_exchange(struct motion *m, const struct motion_operator *wanted);

#endif
