/*
 * What modes make of the way of a drive, as acceleration beside the drive's own.
 */
#ifndef TAKT_HOST_RESONANCE_MODEL_H
#define TAKT_HOST_RESONANCE_MODEL_H

#include "resonance/record.h"

/*
 * The second differences of what a mode of part 1 is away from its foot, by the time squared; at
 * both ends 0.
 */
void resonance_answer(const struct resonance_record *record, double hz, double damping,
                      double *answer_mm_s2);

/* What the tool is accelerated beside its foot. Likewise. */
void resonance_beside(const struct resonance_record *record, double *beside_mm_s2);

#endif
