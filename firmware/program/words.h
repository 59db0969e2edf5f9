/*
 * The words of a line: read, collected with their places, and checked against each other, before
 * any of them does anything.
 */
#ifndef TAKT_PROGRAM_WORDS_H
#define TAKT_PROGRAM_WORDS_H

#include "program/program.h"

/* Reads the words of the current line and checks that they fit together. False: p->error is set. */
bool takt_words_read(struct program *p);

/*
 * Gives the parameters assigned on the line their new values. The old ones are kept in their place
 * until the next line, so that takt_words_take_back can undo it. False: no room, p->error is set,
 * nothing is changed.
 */
bool takt_words_assign(struct program *p);

/* Sets a parameter because the code of a step says so; takt_words_take_back undoes this too. */
bool takt_words_store(struct program *p, enum step step, unsigned number, double value);

void takt_words_take_back(struct program *p);

/* The line counts: what it has set that lasts can be taken back with it (changes.h). */
void takt_words_note_changes(struct program *p);

static inline bool words_has(const struct program *p, char letter)
{
    return (p->words.given & LETTER_BIT(letter)) != 0;
}

static inline double words_value(const struct program *p, char letter)
{
    return p->words.value[LETTER_INDEX(letter)];
}

static inline bool words_has_step(const struct program *p, enum step step)
{
    return (p->words.steps & (UINT32_C(1) << step)) != 0;
}

/* The value of a letter that must be a whole number from low to high. False: p->error is set. */
bool takt_words_whole(struct program *p, char letter, double low, double high, uint32_t *whole);

#endif
