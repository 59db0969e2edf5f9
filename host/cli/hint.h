/*
 * What to do about an error of a program: a line below its message. The images have no room for it.
 */
#ifndef TAKT_HOST_HINT_H
#define TAKT_HOST_HINT_H

#include "base/error.h"

#include <stddef.h>

#define HINT_MAX 400

/*
 * Into text, as lines that end in '\n'; empty when there is nothing to add. line: the line as it is
 * found; at: where the error is in it, length when that is not known.
 */
void hint_write(const struct diagnostic *d, const char *line, size_t length, size_t at,
                char text[HINT_MAX]);

/* What an unknown word is elsewhere, if that is known; else NULL. */
const char *hint_meaning(const struct diagnostic *d);

#endif
