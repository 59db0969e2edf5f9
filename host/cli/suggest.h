/*
 * "Did you mean ...?": the known word nearest to an unknown one.
 */
#ifndef TAKT_HOST_SUGGEST_H
#define TAKT_HOST_SUGGEST_H

#include <stddef.h>

/* Words longer than this are never suggested and never get a suggestion. */
#define SUGGEST_WORD_MAX 63

/*
 * Fewest insertions, deletions, replacements and swaps of neighbours that turn a into b; letters of
 * either case are the same letter. Both at most SUGGEST_WORD_MAX long.
 */
unsigned suggest_distance(const char *a, const char *b);

/*
 * The nearest of the words to word, or NULL when none is near: more than a third of its letters
 * would change. The beginning of a longer word counts as well: max_jrk is near max_jerk_mm_s3.
 */
const char *suggest_word(const char *word, const char *const words[], size_t count);

#endif
