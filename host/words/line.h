/*
 * A line in pieces, as far as they can be told apart without knowing what they mean.
 */
#ifndef TAKT_HOST_WORDS_LINE_H
#define TAKT_HOST_WORDS_LINE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define LINE_MAX_BYTES 2048
#define LINE_WORDS_MAX 128

enum word_kind {
    WORD_VALUE,    /* a letter and its value */
    WORD_BARE,     /* a letter alone */
    WORD_KEYWORD,  /* IF WHILE DO END GOTO THEN, its letter the first of them */
    WORD_BRACKET,  /* [ ... ] behind a keyword */
    WORD_ASSIGNED, /* #1 = value */
    WORD_COMMENT,
    WORD_OTHER /* a character that belongs to nothing */
};

struct line_word {
    enum word_kind kind;
    char letter;         /* in lower case; of others their first character */
    bool is_number;      /* the value is a plain number, */
    double value;        /* this one */
    bool has_point;      /* and it is written with a point */
    uint16_t begin, end; /* in text */
    uint16_t value_begin;
};

struct line {
    char text[LINE_MAX_BYTES + 1];
    size_t length;
    unsigned words;
    struct line_word word[LINE_WORDS_MAX];
};

/* False: it is too long, or has too many words, to be looked at. */
bool line_read(struct line *l, const char *bytes, size_t length);

/* A value as the number of a program, line or tool: cut to what such a number may be. */
uint32_t line_whole(double value);

/* The first word of a letter with a value, from a place on; NULL: none. */
struct line_word *line_find(struct line *l, char letter, unsigned from);

/* N10 that a line begins with, behind a slash and comments; NULL: it has none. */
const struct line_word *line_number(const struct line *l);

/* A G or M word with this number, times ten; NULL: none. */
struct line_word *line_find_code(struct line *l, char letter, unsigned number_x10);

/* Number of a code, times ten; -1: it is none. */
int line_code(const struct line_word *w);

/* Is the word this keyword, given in lower case? */
bool line_is_keyword(const struct line *l, const struct line_word *w, const char *keyword);

/* Spaces take the place of a word, so that all others keep their columns. */
void line_blank(struct line *l, struct line_word *w);

/*
 * A text takes the place of a word; the words have to be read again if it is longer. False: no
 * room.
 */
bool line_replace(struct line *l, struct line_word *w, const char *text);

/* At the end, or in front of a comment that reaches to the end; with a space before it. */
bool line_append(struct line *l, const char *text);

/* #1 = value, and an operator behind it: + - * / MOD AND OR XOR. */
bool line_is_calculation(const struct line *l, const struct line_word *w);

#define LINE_AXES "xyzabc"
bool line_has_axis(struct line *l);

/* Motions and cycles; and what uses axis words beside them. */
void line_look_for_motion(struct line *l, bool *motion, bool *other);

/* G80 ends a cycle, and no other motion begins on the line. */
bool line_ends_cycle(struct line *l);

/* Planes, units, compensation off, length off, systems, path, distances, feed modes; times ten. */
bool line_code_is_mode(int number_x10);

/* No G codes but modes: what its axis words are for is clear. */
bool line_is_plain(const struct line *l);

/* N10 G1 X1*57: where a checksum begins; NULL: there is none. A calculation has none. */
const char *line_checksum(const struct line *l);

/* MSG "text", as Eding CNC has it: the text and its length. NULL: no such line. */
const char *line_message(const struct line *l, size_t *length);

/* %wait, %msg and %X0=posx: what CNCjs does itself. */
bool line_is_order(const struct line *l);

/*
 * PRINT_START BED=60, as Klipper has it: a name of three letters or more begins the line. 0: no
 * such line.
 */
size_t line_macro_length(const struct line *l);

/* (py, ...) and (pyrun, ...), which have LinuxCNC run Python. */
bool line_runs_python(const struct line *l, const struct line_word *w);

/* [BILLET X62 Z70: what a simulator is told of the stock. */
bool line_is_directive(const struct line *l);

/* G70 and G71 without words of their own are inches and millimetres. NULL: no such line. */
struct line_word *line_unit(struct line *l);

/* G53 that does not say how to move, with axes. */
bool line_is_bare_machine(struct line *l);

/* Nothing is left but spaces. */
bool line_is_blank(const struct line *l);

/* Of a name that begins there with a letter: letters, digits and _. */
size_t line_name_length(const struct line *l, size_t at);

/* Is the next character from there, but for spaces, '='? */
bool line_is_assigned(const struct line *l, size_t at);

static inline char line_lower(char c)
{
    return (char)(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
}

/* What O-words go by: <name, or a number without zeros before it. */
#define LINE_LABEL_MAX 64

/* The label of a line's O-word in lower case, and what stands behind it. False: it has none. */
bool line_read_label(const struct line *l, char name[LINE_LABEL_MAX], const char **behind);
/* Does a text begin with a word, which is in lower case? */
bool line_begins(const char *text, const char *word);
/* Does a label with this behind it define a subroutine, or a program? */
bool line_defines_label(const char *behind);

#endif
