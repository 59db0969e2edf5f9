/*
 * Blocks whose setpoints somebody else makes: motion stands before them (MOTION_HANDED_OVER) and is
 * told what becomes of them.
 */
#ifndef TAKT_MOTION_HANDOVER_H
#define TAKT_MOTION_HANDOVER_H

#include "motion/motion.h"

#include <stdbool.h>

/* From now on motion hands over these; linear: before anything is pushed onto its path. */
void takt_handover_allow(struct motion *m, enum motion_handover which);

/*
 * A cycle was made in the path's oldest block. feed: of the setpoint, as it is programmed. Fills
 * the record as takt_motion_cycle.
 */
void takt_handover_add_cycle(struct motion *m, const struct point *at, double feed_mm_s,
                             bool landed, struct cycle_record *record);

/* The oldest block is left without a stop; the next one is executed from now on. */
void takt_handover_pass_block(struct motion *m);

/* The axes stand at the end of the oldest block: motion goes on from there. */
void takt_handover_end(struct motion *m);

#endif
