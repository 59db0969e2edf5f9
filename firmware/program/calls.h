/*
 * Subroutines. O... sub, call, return and endsub with their own #1 ... #30 and local names; and
 * numbered programs, a bare O... with M98 and M99, which share them with their callers.
 *
 * A subroutine is noted, with its place, when its first line is passed. One that is called before
 * lies further down: the text is then passed over from the furthest line read so far.
 */
#ifndef TAKT_PROGRAM_CALLS_H
#define TAKT_PROGRAM_CALLS_H

#include "program/oword.h"

/*
 * Notes the subroutine or numbered program that begins on the current line. False: p->error is set.
 */
bool takt_calls_note(struct program *p, const struct oword *o);

/* O...: executing goes on into it. O... sub: passed over until it is called. */
bool takt_calls_begin_program(struct program *p, const struct oword *o);
bool takt_calls_define(struct program *p, const struct oword *o);
/* O... call */
bool takt_calls_call(struct program *p, const struct oword *o);
/* The same without arguments, for a code of the line. */
bool takt_calls_call_number(struct program *p, const struct program_code *code, uint32_t number);
/* O... return and O... endsub */
bool takt_calls_return(struct program *p, const struct oword *o);

/* An O-word on the way to the end of a definition, or to the subroutine called. */
bool takt_calls_pass(struct program *p, const struct oword *o);

/* The same as takt_flow_end_of_text, for subroutines. */
bool takt_calls_end_of_text(struct program *p);

/* M98 (argument 0), M99 (1) */
bool takt_calls_run_code(struct program *p, const struct program_code *code);

#endif
