/*
 * Cutter-radius compensation as the program asks for it: G40, G41, G42, G41.1, G42.1, and what may
 * not change while it is on. The path stays the programmed one; each move carries side and radius
 * for the room offset.
 */
#ifndef TAKT_PROGRAM_CUTTER_H
#define TAKT_PROGRAM_CUTTER_H

#include "program/program.h"

/* G40 */
bool takt_cutter_cancel(struct program *p, const struct program_code *code);
/* G41, G42: the radius of tool D, else of the tool in the spindle; argument: enum cutter_side */
bool takt_cutter_use_tool(struct program *p, const struct program_code *code);
/* G41.1, G42.1: D is the diameter; argument: enum cutter_side */
bool takt_cutter_use_diameter(struct program *p, const struct program_code *code);

/* May this code act now? False: compensation is on and forbids it, p->error is set. */
bool takt_cutter_allows(struct program *p, const struct program_code *code);
/*
 * After a code has acted: false when it has moved the coordinates of a compensated path, p->error
 * is set.
 */
bool takt_cutter_allows_change(struct program *p, const struct program_code *code,
                               const struct program_modes *before);

/* Gives a motion from the current position side and radius. */
void takt_cutter_apply(struct program *p, struct move *m);

#endif
