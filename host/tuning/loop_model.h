/*
 * A drive's loops on what was identified, without limits and steps of the encoder: the answer to a
 * step of the target.
 */
#ifndef TAKT_HOST_TUNING_LOOP_MODEL_H
#define TAKT_HOST_TUNING_LOOP_MODEL_H

#include "tuning/gains.h"

/* How far it goes beyond the step, part of it; infinite: it does not come to rest there. */
double loop_model_overshoot(const struct tuning_plant *plant, const struct tuning_drive *drive,
                            const struct tuning_gains *gains);

#endif
