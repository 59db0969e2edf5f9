/*
 * What words of a program mean, one line each: for who reads one in an editor. Which codes there
 * are says the table of firmware/program/codes.c; test_editor_meaning holds the two together.
 */
#ifndef TAKT_HOST_MEANING_H
#define TAKT_HOST_MEANING_H

#include <stddef.h>

/* Meaning of a code, its number times ten; NULL: takt has none of this number. */
const char *meaning_of_code(char letter, unsigned number_x10);
/* Meaning of a word that is no code, by its letter in lower case; NULL: it is none. */
const char *meaning_of_letter(char letter);
/*
 * Meaning of what stands behind the label of an O-word, in any case; *length: of that text. NULL:
 * nothing known.
 */
const char *meaning_of_flow(const char *text, size_t *length);

#endif
