/*
 * UTF-8: what texts for other programs are declared as; names of files may be anything.
 */
#ifndef TAKT_HOST_UTF8_H
#define TAKT_HOST_UTF8_H

#include <stddef.h>

/* What editors of some systems put before a text. */
#define UTF8_MARK "\xEF\xBB\xBF"

/* Bytes of the character that begins here in a text that ends with a zero; 0: none does. */
size_t utf8_length(const char *text);

#endif
