/*
 * M70 to M73: modes saved and brought back, one set per call.
 */
#ifndef TAKT_PROGRAM_SAVED_MODES_H
#define TAKT_PROGRAM_SAVED_MODES_H

#include "program/program.h"

/*
 * M70 saves, M71 forgets, M72 brings back, M73 saves and brings back when the call ends; argument:
 * 0 ... 3.
 */
bool takt_saved_modes_run_code(struct program *p, const struct program_code *code);

/*
 * Brings the modes that a call has saved back, with a move for the spindle and one for the coolant
 * if they change. False: nothing is changed, because a compensated contour is under way that could
 * not go on.
 */
bool takt_saved_modes_restore(struct program *p, const struct program_frame *frame);

/* Where in struct program_flow, kept, everything of a call and its callers ends. */
unsigned takt_saved_modes_end(const struct program_frame *frame);

#endif
