/*
 * Probing: G38.2 to G38.5.
 *
 * The interpreter makes one move to the programmed end and reads on as if it had ended there without contact. Who
 * runs the program waits for the end of the move and says what became of it by program_set_probe (program.h), before
 * the next move is asked for.
 */
#ifndef TAKT_PROGRAM_PROBE_H
#define TAKT_PROGRAM_PROBE_H

#include "program/program.h"

/* argument: sum of enum probe */
enum probe { PROBE_OPTIONAL = 1, PROBE_AWAY = 2 };
bool probe_move(struct program *p, const struct program_code *code);

#endif
