/*
 * Programs for other controllers, read as what they mean: text in, text in takt's own language out,
 * line for line.
 *
 *     bytes -> line (words) -> table of differences -> text
 *
 * A dialect is a set of rows of one table (difference.c) and a few rules. Nothing is interpreted
 * here: what a line comes to may depend on words before it in the text, never on values.
 */
#ifndef TAKT_HOST_DIALECT_H
#define TAKT_HOST_DIALECT_H

#include "translation/codes.h"
#include "translation/dialects.h"
#include "translation/result.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What a program says of itself. */
struct dialect_guess {
    enum dialect dialect;
    bool absolute;     /* centres of arcs are absolute, though it does not say so */
    bool translates;   /* it has something that is not to be read as it stands */
    uint32_t line;     /* where it says so, from 1; 0: nowhere */
    char evidence[32]; /* the word there */
};

/* Where arcs of the plane XY have their centres, as far as plain numbers tell. */
struct dialect_arcs {
    double at[2];                /* X and Y */
    bool known[2];               /* the program has given them */
    bool incremental, turns;     /* G91; G2 or G3 is in effect */
    bool said;                   /* it has G90.1 or G91.1 */
    unsigned relative, absolute; /* arcs that only fit so */
    uint32_t line;               /* the first that is absolute */
};

/*
 * Looks at a program line by line; all zeros before the first. dialect_guess_end says what it has
 * come to.
 */
struct dialect_detector {
    uint32_t line;
    bool calls;         /* it has a call, O... call or M98: perhaps of another file */
    bool moves;         /* it has a motion code */
    bool ended_cycle;   /* and the last one was G80 */
    uint32_t bare_line; /* axis words before that; 0: none */
    char bare[32];
    bool numbered;  /* it has a number, O1000 */
    bool linuxcnc;  /* it has what only LinuxCNC knows */
    unsigned named; /* bits: dialects its comments name, */
    unsigned alone; /* and those of which it has what no other dialect has */
    struct dialect_arcs arcs;
    uint32_t found_line[DIALECT_COUNT]; /* 0: nothing */
    char found[DIALECT_COUNT][32];
    bool translates;
};

void dialect_guess_line(struct dialect_detector *d, const char *line, size_t length,
                        const struct dialect_codes *codes);
struct dialect_guess dialect_guess_end(const struct dialect_detector *d);

/*
 * The whole of a program, of length bytes. Its lines keep their numbers: where one becomes several,
 * the further ones begin with DIALECT_GOES_ON, which the interpreter does not count. called: it is
 * the subprogram of this name; NULL: the program itself. False: out of memory.
 */
bool dialect_translate(enum dialect dialect, const struct dialect_codes *codes, const char *called,
                       const char *bytes, size_t length, struct dialect_result *result);

#endif
