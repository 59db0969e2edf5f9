/*
 * Programs for other controllers, read as what they mean: text in, text in takt's own language out, line for line.
 *
 *     bytes -> line (words) -> table of differences -> text
 *
 * A dialect is a set of rows of one table (difference.c) and a few rules. Nothing is interpreted here: what a line comes to may
 * depend on words before it in the text, never on values.
 */
#ifndef TAKT_HOST_DIALECT_H
#define TAKT_HOST_DIALECT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum dialect {
    DIALECT_LINUXCNC,
    DIALECT_GRBL,
    DIALECT_FANUC,
    DIALECT_HAAS,
    DIALECT_MACH3,
    DIALECT_MARLIN,
    DIALECT_SIEMENS,
    DIALECT_COUNT,
    DIALECT_AUTO = DIALECT_COUNT
};

/* As in options; NULL when there is no such number. */
const char *dialect_name(enum dialect dialect);
/* DIALECT_COUNT + 1: none has this name. */
unsigned dialect_find(const char *name);

/* What becomes of a code that the machine file declares. */
enum dialect_use {
    DIALECT_IGNORE,    /* and the words right behind it that are no axes, F, S or T */
    DIALECT_STOP,      /* M0 */
    DIALECT_OUTPUT_ON, /* M64 P number */
    DIALECT_OUTPUT_OFF,
    DIALECT_FEED,       /* F: what it is before the program gives one, mm/min */
    DIALECT_SUBROUTINE, /* O<name> call, behind the rest of its line, with P, Q and R as #1, #2 and #3 */
    DIALECT_AXIS,       /* U V W: the axis of the machine that this letter drives */
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

/* What a program asks of LinuxCNC's configuration: #<_ini[SECTION]NAME>, #<_hal[PIN]>; what senders put for #NAME; and #<_NAME>. */
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

/* "M31" and "ignore", "output 3 on", "output 3 off", "subroutine NAME", "stop"; "F" and "600"; "U" and "A" or "ignore"; "R" and "height" or "distance". NULL: it is right; else what is wrong. */
const char *dialect_code_read(struct dialect_code *code, const char *name, const char *value);

/* "M31 = ignore", as in a machine file. */
#define DIALECT_CODE_TEXT_MAX 96
void dialect_code_write(const struct dialect_code *code, char text[DIALECT_CODE_TEXT_MAX]);

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

/* Looks at a program line by line; all zeros before the first. dialect_guess_end says what it has come to. */
struct dialect_detector {
    uint32_t line;
    bool calls;         /* it has a call, O... call or M98: perhaps of another file */
    bool moves;         /* it has a motion code */
    bool ended_cycle;   /* and the last one was G80 */
    uint32_t bare_line; /* axis words before that; 0: none */
    char bare[32];
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

/* A growing text. */
struct dialect_text {
    char *bytes; /* NULL: empty */
    size_t length, room;
    bool failed; /* out of memory */
};

void dialect_text_free(struct dialect_text *t);

/* Something a line asks for and does not get: told once for each code. */
struct dialect_note {
    uint32_t line, column; /* from 1 */
    char word[16];
    const char *meaning; /* what it is for; NULL: the machine file says so */
};
#define DIALECT_NOTES_MAX 32

struct dialect_result {
    struct dialect_text text;
    struct dialect_note note[DIALECT_NOTES_MAX];
    unsigned notes;
    uint32_t
        wrong_line; /* 0: nothing is wrong; else a jump of this line to an N that is not there, or is in a loop */
    unsigned wrong_number;
};

/*
 * The whole of a program, of length bytes. Its lines keep their numbers: where one becomes several, the further ones begin with
 * DIALECT_GOES_ON, which the interpreter does not count. False: out of memory.
 */
bool dialect_translate(enum dialect dialect, const struct dialect_codes *codes, const char *bytes,
                       size_t length, struct dialect_result *result);

/* What ends a text under DOS: nothing of its line counts from there on. */
#define DIALECT_TEXT_END '\x1a'

/* As in firmware/program/lexer.h. */
#define DIALECT_GOES_ON '\x1f'

#endif
