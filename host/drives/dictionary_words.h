/*
 * Words and numbers of an electronic data sheet.
 */
#ifndef TAKT_DRIVES_DICTIONARY_WORDS_H
#define TAKT_DRIVES_DICTIONARY_WORDS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct text_part {
    const char *start;
    size_t length;
};

/* Without the spaces at its ends. */
struct text_part words_trim(const char *start, size_t length);
/* In any case; word: in lower case. */
bool words_are(struct text_part part, const char *word);
/* Without $NODEID and its sign, *has_node then. False: no number. */
bool words_read_number(struct text_part part, int64_t *number, bool *has_node);
/* What is no number, or a negative one, is otherwise. */
long words_plain_number(struct text_part part, long otherwise);
/* Digits from the start of a part; how many. */
size_t words_read_hex(struct text_part part, size_t most, unsigned *number);

#endif
