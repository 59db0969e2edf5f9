/*
 * Axes named on the command line.
 */
#ifndef TAKT_HOST_AXIS_LETTERS_H
#define TAKT_HOST_AXIS_LETTERS_H

#include <stdbool.h>

/* Letters to bits, as in XY; NULL: 0. False after a message: there is another letter. */
bool axis_letters_read(const char *text, unsigned *axes);

#endif
