/*
 * The text of an electronic data sheet, whatever it was written on.
 */
#ifndef TAKT_DRIVES_DICTIONARY_TEXT_H
#define TAKT_DRIVES_DICTIONARY_TEXT_H

#include <stddef.h>

/*
 * A copy with one byte a character and lines that end with \n: UTF-16 (by its byte order mark),
 * whose characters above 7F become ?, and line ends of \r are understood. *length: of text, then of
 * the copy. The caller frees it; NULL: out of memory.
 */
char *dictionary_plain_text(const char *text, size_t *length);

#endif
