/*
 * The word of a diagnostic, put together from pieces; what does not fit is cut.
 */
#ifndef TAKT_DRIVE_WORD_H
#define TAKT_DRIVE_WORD_H

#include "base/error.h"

#include <stdint.h>

struct word {
    char text[DIAGNOSTIC_WORD_MAX];
    unsigned length;
};

void takt_word_add_text(struct word *word, const char *text);
void takt_word_add_number(struct word *word, uint32_t number);
/* With this many digits, 1 ... 8. */
void takt_word_add_hex(struct word *word, uint32_t number, unsigned digits);

#endif
