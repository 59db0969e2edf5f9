/*
 * Comments that are orders: (abort, TEXT) ends the program; the others, (MSG, TEXT) and the like,
 * are the caller's.
 */
#ifndef TAKT_PROGRAM_COMMENT_H
#define TAKT_PROGRAM_COMMENT_H

#include "program/program.h"

/* Of a letter its small one; anything else as it is. */
char takt_comment_lower(char c);
/*
 * What begins the line's last comment, after spaces and whatever its case: how far it reaches, or
 * 0. word: in lower case.
 */
unsigned takt_comment_match(const struct program_lexer *l, const char *word);

/* What the line's last comment asks for; false: p->error is set. */
bool takt_comment_run(struct program *p);

#endif
