/*
 * The table of everything a G, M, F, S or T word can ask for: the one place to add a code.
 */
#ifndef TAKT_PROGRAM_CODES_H
#define TAKT_PROGRAM_CODES_H

#include <stdbool.h>
#include <stdint.h>

struct program;

/*
 * What a line asks for is done in this order, whatever the order of its words: the order of
 * execution of RS274/NGC.
 */
enum step {
    STEP_SPINDLE_MODE,
    STEP_FEED_MODE,
    STEP_FEED,
    STEP_SPEED,
    STEP_TOOL_SELECT,
    STEP_CHANNEL,
    STEP_TOOL_CHANGE,
    STEP_SPINDLE,
    STEP_MODES,
    STEP_COOLANT,
    STEP_OVERRIDE,
    STEP_CORRECTION,
    STEP_DWELL,
    STEP_PLANE,
    STEP_UNITS,
    STEP_DIAMETER,
    STEP_CUTTER,
    STEP_TOOL_LENGTH,
    STEP_SYSTEM,
    STEP_PATH,
    STEP_DISTANCE,
    STEP_CENTRE,
    STEP_RETRACT,
    STEP_MACHINE,
    STEP_SETTING,
    STEP_REFERENCE,
    STEP_AXIS_OFFSET,
    STEP_AXIS_APPLIED,
    STEP_MOTION,
    STEP_STOP,
    STEP_COUNT
};

/* Modal groups: two codes of one group contradict each other on a line. */
enum group {
    GROUP_NONE, /* F, S, T: repeated letters are found as such */
    GROUP_NON_MODAL,
    GROUP_MOTION,
    GROUP_PLANE,
    GROUP_DISTANCE,
    GROUP_CENTRE,
    GROUP_FEED_MODE,
    GROUP_UNITS,
    GROUP_CUTTER,
    GROUP_TOOL_LENGTH,
    GROUP_SYSTEM,
    GROUP_PATH,
    GROUP_STOP,
    GROUP_TOOL_CHANGE,
    GROUP_SPINDLE,
    GROUP_COOLANT,
    GROUP_OVERRIDE,
    GROUP_CORRECTION,
    GROUP_MODES,
    GROUP_SPINDLE_MODE,
    GROUP_CHANNEL,
    GROUP_DIAMETER,
    GROUP_RETRACT,
    GROUP_AXIS_APPLIED
};

/* number_x10 of the codes for F, S and T, whose number is a value. */
#define CODE_ANY 0xffff

struct program_code {
    char letter;         /* lower case */
    uint16_t number_x10; /* G92.1 is 921, M3 is 30 */
    enum group group;
    enum step step;
    int16_t argument; /* for the handler */
    uint32_t words;   /* letters it uses: bit 0 is A */
    /* False: p->error is set. */
    bool (*run)(struct program *p, const struct program_code *code);
};

/* NULL when there is no such code. */
const struct program_code *takt_code_find(char letter, unsigned number_x10);

/* Bit of a letter in given, words and the like. */
#define LETTER_INDEX(letter) ((unsigned)((letter) - 'a'))
#define LETTER_BIT(letter)   (UINT32_C(1) << LETTER_INDEX(letter))

/* The axis words. */
#define LETTERS_LINEAR (LETTER_BIT('x') | LETTER_BIT('y') | LETTER_BIT('z'))
#define LETTERS_ROTARY (LETTER_BIT('a') | LETTER_BIT('b') | LETTER_BIT('c'))
#define LETTERS_AXES   (LETTERS_LINEAR | LETTERS_ROTARY)
/* The offsets of an arc's centre. */
#define LETTERS_CENTRE (LETTER_BIT('i') | LETTER_BIT('j') | LETTER_BIT('k'))

#endif
