/*
 * Named parameters #<name>, and the texts of their names and those of O-words. Names are as the
 * lexer leaves them: lower case, no spaces, 1 to PROGRAM_NAME_MAX characters.
 *
 * All texts are in one place, each once, so that names are compared and kept as numbers. One that
 * is only looked for stands there until the next; what nobody is named by any more makes room when
 * there is none.
 */
#ifndef TAKT_PROGRAM_NAMES_H
#define TAKT_PROGRAM_NAMES_H

#include "program/program.h"

/*
 * Which it is of the globals and the locals of the current call; -1 when nothing of that name has
 * been set.
 */
int takt_names_find(const struct program_names *names, const char *name, size_t length);

/* Adds a name that is not there, with the value 0; NULL when there is no room. */
double *takt_names_add(struct program *p, const char *name, size_t length);

/* Where a text is. It stays there until another is asked for, or for good after takt_names_keep. */
uint16_t takt_names_place(struct program_names *names, const char *text, size_t length);

/*
 * Keeps the text at a place, which may then be another, for as long as anything is named by it.
 * False: there is no room. Until it names something no other may be kept.
 */
bool takt_names_keep(struct program *p, uint16_t *place);

/* A call begins without local names, and they end with it. */
void takt_names_enter_call(struct program_names *names);
void takt_names_leave_call(struct program_names *names);

#endif
