/*
 * What the user has written where a translation has made words of its own.
 */
#ifndef TAKT_HOST_FOUND_WORD_H
#define TAKT_HOST_FOUND_WORD_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>

/* O100 IF, O<NAME> CALL */
bool found_word_is_oword(const char *word);

/*
 * About a line, as it is found, of a program that has been translated: an O-word that is not in it
 * is called what stands in the line, and a variable loses what it has been given in front. A name
 * that nobody has translated is unknown as a whole, not a letter without a number.
 */
void found_word_restore(const char *line, size_t length, struct diagnostic *d);

#endif
