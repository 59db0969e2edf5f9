/* What the machine file says about programs: codes, letters, and values of names. */
#ifndef TAKT_HOST_TRANSLATION_CODES_H
#define TAKT_HOST_TRANSLATION_CODES_H

#include "words/line.h"

#include <stdbool.h>
#include <stdint.h>

/* What becomes of a code that the machine file declares. */
enum dialect_use {
    DIALECT_IGNORE,    /* and the words right behind it that are no axes, F, S or T */
    DIALECT_STOP,      /* M0 */
    DIALECT_OUTPUT_ON, /* M64 P number */
    DIALECT_OUTPUT_OFF,
    DIALECT_FEED, /* F: what it is before the program gives one, mm/min */
    /* O<name> call, behind the rest of its line, with P, Q and R as #1, #2 and #3 */
    DIALECT_SUBROUTINE,
    DIALECT_AXIS,    /* U V W: the axis of the machine that this letter drives */
    DIALECT_HEIGHT,  /* R of drilling on lathes: a coordinate, */
    DIALECT_DISTANCE /* or from where the tool is when the cycle begins */
};

#define DIALECT_SUBROUTINE_MAX 63
#define DIALECT_CODES_MAX      64

struct dialect_code {
    char letter;         /* 'g', 'm', 'f', 'r', 'u', 'v' or 'w' */
    uint16_t number_x10; /* M31: 310 */
    enum dialect_use use;
    unsigned number; /* of an output; a feed */
    char axis;       /* DIALECT_AXIS: in upper case */
    char subroutine[DIALECT_SUBROUTINE_MAX + 1];
};

/*
 * What a program asks of LinuxCNC's configuration: #<_ini[SECTION]NAME>, #<_hal[PIN]>; what senders
 * put for #NAME; and #<_NAME>.
 */
struct dialect_value {
    char name[64]; /* "_ini[SECTION]NAME", "_hal[PIN]", "NAME", "_NAME" */
    double value;
};

/* What the machine file says about programs. */
struct dialect_codes {
    unsigned count;
    struct dialect_code code[DIALECT_CODES_MAX];
    unsigned values;
    struct dialect_value value[DIALECT_CODES_MAX];
};

/* Adds a value, or changes it. NULL: it is right; else what is wrong. */
const char *dialect_value_set(struct dialect_codes *codes, const char *name, const char *value);

/*
 * "M31" and "ignore", "output 3 on", "output 3 off", "subroutine NAME", "stop"; "F" and "600"; "U"
 * and "A" or "ignore"; "R" and "height" or "distance". NULL: it is right; else what is wrong.
 */
const char *dialect_code_read(struct dialect_code *code, const char *name, const char *value);

/* U, V or W, which may be letters of other axes. */
bool codes_is_letter(const struct line_word *w);
/* What the machine file declares a word as; NULL: nothing. */
const struct dialect_code *codes_find(const struct dialect_codes *codes, const struct line_word *w);

/* "M31 = ignore", as in a machine file. */
#define DIALECT_CODE_TEXT_MAX 96
void dialect_code_write(const struct dialect_code *code, char text[DIALECT_CODE_TEXT_MAX]);

#endif
