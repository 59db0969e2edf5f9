/*
 * The table of differences: what a code of other controllers is here.
 */
#ifndef TAKT_HOST_DIALECT_DIFFERENCE_H
#define TAKT_HOST_DIALECT_DIFFERENCE_H

#include "dialect/dialect.h"

enum difference_kind {
    /* the code, and the words right behind it that only it can use; with a warning */
    DIFFERENCE_DROP,
    DIFFERENCE_AXES,   /* the same, and its axis words: it moves nothing */
    DIFFERENCE_QUIET,  /* as the first without a warning: it changes nothing */
    DIFFERENCE_LINE,   /* the whole line; with a warning */
    DIFFERENCE_REPLACE /* the code is this text */
};

struct difference {
    unsigned dialects; /* bits */
    char letter;
    uint16_t first_x10, last_x10; /* numbers of codes, times ten, both included */
    enum difference_kind kind;
    /* no program for LinuxCNC has it: which one has, is written for one of these dialects */
    bool tells;
    const char *text; /* DIFFERENCE_REPLACE; else what it is for */
};

/* The row for a code; NULL: it means the same. */
const struct difference *difference_find(enum dialect dialect, char letter, unsigned number_x10);

/* The dialects that a code tells of, as bits; 0: it tells nothing. */
unsigned difference_dialects(char letter, unsigned number_x10);

#endif
