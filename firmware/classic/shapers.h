/*
 * Input shapers as printers' firmware has them, for comparison with the room shape: trains of
 * impulses for one mode, at times that lie between cycles. As struct shape_config wants them.
 */
#ifndef TAKT_CLASSIC_SHAPERS_H
#define TAKT_CLASSIC_SHAPERS_H

#include "shape/train.h"
#include "shape/zv.h"

/* Modified zero vibration: three impulses in three quarters of a period. */
void takt_shapers_mzv(const struct shape_mode *mode, double cycle_s, struct train *t);

/* Extra insensitive: three in a period; 5 % are left, also where the frequency is off. */
void takt_shapers_ei(const struct shape_mode *mode, double cycle_s, struct train *t);

#endif
