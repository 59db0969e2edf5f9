/*
 * Zero vibration (Singer and Seering 1990): a half of a motion now, the other half of it half a
 * period later, when the mode swings back. Here in whole cycles, so that nothing is left whatever
 * the period is of a cycle.
 */
#ifndef TAKT_SHAPE_ZV_H
#define TAKT_SHAPE_ZV_H

#include "shape/train.h"

/* A mode between motor and tool. */
struct shape_mode {
    double hz; /* 0: none */
    double damping;
    double part; /* of it that the tool sees; 1: all */
};

/*
 * A mode above this part of the cycle's rate cannot be shaped: half of its period is less than two
 * cycles.
 */
#define SHAPE_HZ_CYCLE_MAX 0.25

/* Period of its free swing, cycles. */
double takt_zv_period(const struct shape_mode *mode, double cycle_s);

void takt_zv_train(const struct shape_mode *mode, double cycle_s, struct train *t);

#endif
