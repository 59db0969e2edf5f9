/* The second half of making a ceiling (ceiling.h), over pieces that lie already. */
#ifndef TAKT_PLAN_CEILING_BACKWARD_H
#define TAKT_PLAN_CEILING_BACKWARD_H

#include "plan/ceiling.h"
#include "plan/ramp_profile.h"

/*
 * Sets the feeds at the ends of all pieces, at the present overrides and at the highest, and what
 * junctions they land at.
 */
void takt_ceiling_plan_backward(struct ceiling *c, enum ramp_profile profile);

#endif
