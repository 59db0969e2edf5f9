/*
 * What struct program consists of. Callers own the memory and touch nothing in it; included by program.h alone.
 */
#ifndef TAKT_PROGRAM_STATE_H
#define TAKT_PROGRAM_STATE_H

#include "program/codes.h"
#include "program/program_limits.h"

#include <stddef.h>

/* A piece of the current line: indices into struct program_lexer, text. */
struct program_span {
    uint16_t begin, end;
};

/* The current line, without spaces, tabs and comments and in lower case. */
struct program_lexer {
    struct source source;
    char input[PROGRAM_INPUT_MAX];
    size_t input_at, input_length;
    uint32_t line;                         /* number of the current line, from 1 */
    uint16_t at;                           /* next character to read */
    uint16_t length;                       /* of text */
    char text[PROGRAM_LINE_MAX + 1];       /* ends in zero */
    uint16_t column[PROGRAM_LINE_MAX + 1]; /* of every character and of the end, from 1 */
    uint8_t nesting;                       /* values being read now */
};

/* What an assignment or an expression names after '#'. */
struct program_reference {
    uint16_t number;          /* 0: by name */
    struct program_span span; /* the name alone, or all of '#...' */
};

struct program_assignment {
    struct program_reference reference;
    double value;
};

/* The words of the current line. */
struct program_words {
    uint32_t given; /* letters with a value: bit 0 is A */
    uint32_t steps; /* codes to execute: bits are enum step */
    uint32_t groups;
    double value[26];
    struct program_span span[26];
    const struct program_code *code[STEP_COUNT];
    struct program_span code_span[STEP_COUNT];
    unsigned assignments;
    uint16_t names_before; /* names known before the line */
    /* Done ones hold the value from before. */
    struct program_assignment assignment[PROGRAM_ASSIGNMENTS_MAX + PROGRAM_STORES_MAX];
};

/* Named parameters. */
struct program_names {
    uint16_t count;
    char text[PROGRAM_NAMES_MAX][PROGRAM_NAME_MAX + 1];
    double value[PROGRAM_NAMES_MAX];
};

/* Everything one line leaves for the next; a line with an error leaves it as it was. */
struct program_modes {
    struct point at;                   /* machine position after the last move */
    struct point system_offset;        /* G54 ... G59.3 */
    struct point axis_offset;          /* G92 */
    struct point tool_offset;          /* G43 */
    const struct program_code *motion; /* G0, G1, G2, G3, or NULL after G80 */
    double unit_mm;                    /* G20: 25.4, G21: 1 */
    double feed_mm_s, feed_rad_s;      /* the last F, along X Y Z and along A B C; 0: none */
    double tolerance_mm;               /* G64 */
    double speed_rpm;                  /* S */
    enum plane plane;
    enum move_path path;
    enum spindle_direction direction;
    uint32_t tool_selected; /* T */
    uint32_t tool_current;  /* M6 */
    bool tool_is_selected;
    bool incremental;     /* G91 */
    bool centre_absolute; /* G90.1 */
    bool inverse_time;    /* G93 */
    bool mist, flood;
    uint8_t system; /* 1: G54 ... 9: G59.3 */
};

enum program_phase { PROGRAM_AT_START, PROGRAM_IN_TEXT, PROGRAM_ENDED };

struct program {
    struct program_config config;
    struct program_lexer lexer;
    struct program_words words;
    struct program_modes modes;
    struct program_names names;
    struct move queue[PROGRAM_QUEUE_MAX]; /* made by the current line, not yet fetched */
    unsigned queue_first, queue_count;
    struct diagnostic error;
    struct diagnostic warning[PROGRAM_WARNINGS_MAX];
    unsigned warnings;
    enum program_phase phase;
};

#endif
