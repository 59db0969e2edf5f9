/*
 * Named parameters #<name>. Names are as the lexer leaves them: lower case, no spaces.
 */
#ifndef TAKT_PROGRAM_NAMES_H
#define TAKT_PROGRAM_NAMES_H

#include "program/program.h"

/* The global, or the local of the current call; NULL when nothing of that name has been set. */
double *names_find(struct program_names *names, const char *name, size_t length);

/* Adds a name that is not there, 1 to PROGRAM_NAME_MAX long, with the value 0; NULL when there is no room. */
double *names_add(struct program_names *names, const char *name, size_t length);

/* A call begins without local names, and they end with it. */
void names_enter_call(struct program_names *names);
void names_leave_call(struct program_names *names);

#endif
