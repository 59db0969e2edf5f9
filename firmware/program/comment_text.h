/*
 * What a comment says, for those who can show it: an image that does not is linked without this.
 */
#ifndef TAKT_PROGRAM_COMMENT_TEXT_H
#define TAKT_PROGRAM_COMMENT_TEXT_H

#include "program/program.h"

#include <stddef.h>

/* Room for what a comment of a whole line comes to, parameters included. */
#define COMMENT_TEXT_MAX 1024

enum comment_kind {
    COMMENT_PLAIN,
    COMMENT_MESSAGE, /* (MSG, ...), (DEBUG, ...), (PRINT, ...) */
    COMMENT_ABORT,   /* (ABORT, ...): the program ends with it */
    COMMENT_LOG,     /* (LOG, ...): a line for the log */
    COMMENT_LOG_OPEN,
    COMMENT_LOG_APPEND,
    COMMENT_LOG_CLOSE,
    COMMENT_PROBE_OPEN, /* (PROBEOPEN FILE): a line for every contact of a probing move */
    COMMENT_PROBE_CLOSE
};

/*
 * What the last comment of the current line is, and its text, ending in zero, without the word that
 * says so. In the texts of DEBUG, PRINT, LOG and ABORT #1 and #<name> are the values of the
 * parameters, with the places that %d (none), %f (four) or %.2f before them ask for; six without.
 * One that is not known is ######.
 */
enum comment_kind takt_comment_read(const struct program *p, char text[COMMENT_TEXT_MAX]);

#endif
