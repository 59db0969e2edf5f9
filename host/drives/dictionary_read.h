/*
 * Dictionaries (servo/dictionary.h) of electronic data sheets.
 */
#ifndef TAKT_DRIVES_DICTIONARY_READ_H
#define TAKT_DRIVES_DICTIONARY_READ_H

#include "servo/dictionary.h"

#include <stdbool.h>
#include <stddef.h>

#define DICTIONARY_PROBLEM_MAX 120

/* What is wrong with a data sheet. */
struct dictionary_problem {
    unsigned line; /* from 1; 0: the whole */
    char text[DICTIONARY_PROBLEM_MAX + 1];
};

/*
 * Reads the text of a data sheet, or of a configuration (DCF, with a section DeviceComissioning),
 * whose parameter values count before defaults; in a data sheet they count where there is no
 * default. False: *wrong says why. A value that is not understood counts as none, as it is with the
 * tools that write them.
 */
bool dictionary_read(struct dictionary *dictionary, const char *text, size_t length,
                     struct dictionary_problem *wrong);
/* Frees what dictionary_read has made. */
void dictionary_free(struct dictionary *dictionary);

#endif
