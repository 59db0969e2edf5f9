/*
 * Probing: G38.2 to G38.5.
 *
 * The interpreter makes one move to the programmed end and sets the parameters as if it had ended
 * there without contact. Who runs the program says what became of it by takt_program_answer
 * (program.h).
 */
#ifndef TAKT_PROGRAM_PROBE_H
#define TAKT_PROGRAM_PROBE_H

#include "program/program.h"

/* argument: sum of enum probe */
enum probe { PROBE_OPTIONAL = 1, PROBE_AWAY = 2 };
bool takt_probe_move(struct program *p, const struct program_code *code);

/* The probing move has ended: sets position and parameters. */
void takt_probe_take(struct program *p, const struct program_answer *answer);

#endif
