/*
 * Lines: from the source's bytes to the current line's characters, and where in the text they
 * stood.
 */
#ifndef TAKT_PROGRAM_LEXER_H
#define TAKT_PROGRAM_LEXER_H

#include "program/program.h"

/*
 * A line that begins with it goes on with the one before, whose number it has: a translator makes
 * several lines of one. The first line has none to go on with: there it is unknown.
 */
#define LEXER_GOES_ON 0x1f

enum lexer_result { LEXER_LINE, LEXER_END, LEXER_ERROR, LEXER_UNREADABLE };

void takt_lexer_open(struct program_lexer *l, const struct source *source);

/* False: what comes next has not come yet (SOURCE_LATER). */
bool takt_lexer_can_go_on(struct program_lexer *l);

/*
 * Reads the next line whole, whatever its length. LEXER_ERROR: *error says what is wrong with it;
 * the one after it can be read. LEXER_UNREADABLE: the source fails.
 */
enum lexer_result takt_lexer_next_line(struct program_lexer *l, struct diagnostic *error);

/* A character of the line's last comment, as it stands there; 0 behind its end. */
char takt_lexer_comment(const struct program_lexer *l, unsigned at);

/* The column, from 1, of a character of the current line or of its end. */
uint16_t takt_lexer_column(const struct program_lexer *l, unsigned at);

/* Where the line after the current one begins. */
struct program_place takt_lexer_place(const struct program_lexer *l);

/* Where the current line begins. */
struct program_place takt_lexer_this_line(const struct program_lexer *l);

bool takt_lexer_can_seek(const struct program_lexer *l);

/* Goes on at a place takt_lexer_place gave. False: the source cannot go there. */
bool takt_lexer_seek(struct program_lexer *l, const struct program_place *place);

/* True and past it, when the line goes on with c. */
bool takt_lexer_accept(struct program_lexer *l, char c);

#endif
