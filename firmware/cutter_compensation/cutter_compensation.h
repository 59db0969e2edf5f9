/*
 * Cutter-radius compensation: programmed moves in, moves of the tool's centre out.
 *
 *     takt_program_next -> [ way | corner | way | ... ] -> takt_cutter_compensation_next
 *
 * Moves without compensation pass unchanged and undelayed. The caller owns struct
 * cutter_compensation and reads the program through it alone.
 */
#ifndef TAKT_CUTTER_COMPENSATION_H
#define TAKT_CUTTER_COMPENSATION_H

#include "cutter_compensation/compensation_state.h"
#include "program/program.h"

/* Makes o ready for a program just opened with config. */
void takt_cutter_compensation_open(struct cutter_compensation *o,
                                   const struct program_config *config);

/*
 * The next move, with the contract of takt_program_next: after PROGRAM_ERROR reading may go on;
 * what is left of a contour with an error is dropped. PROGRAM_WAIT comes when everything before it
 * has been given out.
 */
enum program_result takt_cutter_compensation_next(struct cutter_compensation *o, struct program *p,
                                                  struct move *move, struct diagnostic *diagnostic);

/* takt_program_answer, of a program that is read through o. */
void takt_cutter_compensation_answer(struct cutter_compensation *o, struct program *p,
                                     const struct program_answer *answer);

/*
 * Warnings since the last call: true and *diagnostic while there are any; those of the program come
 * elsewhere.
 */
bool takt_cutter_compensation_warning(struct cutter_compensation *o, struct diagnostic *diagnostic);

#endif
