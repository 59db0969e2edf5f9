/*
 * Every fixed size of the interpreter; a build may have others of those that can be defined before.
 * struct program and struct parameters together stay below PROGRAM_MEMORY_MAX bytes (checked in
 * program.c).
 */
#ifndef TAKT_PROGRAM_LIMITS_H
#define TAKT_PROGRAM_LIMITS_H

#define PROGRAM_MEMORY_MAX 49152

/* Characters of a line, comments included, its end not (LinuxCNC's limit). */
#define PROGRAM_LINE_MAX 256
/* Bytes asked from the source at once. */
#ifndef PROGRAM_INPUT_MAX
#define PROGRAM_INPUT_MAX 512
#endif
/* Moves one line can make: S T M6 (two) M3 M8 G4 G28 (two) M2 are ten. */
#define PROGRAM_QUEUE_MAX 12
/* Tools whose values a program can change by G10. */
#ifndef PROGRAM_TOOL_CHANGES_MAX
#define PROGRAM_TOOL_CHANGES_MAX 16
#endif
/* Changes of offsets, tools and other things that last, which can be taken back. */
#ifndef PROGRAM_CHANGES_MAX
#define PROGRAM_CHANGES_MAX 64
#endif
/* L of a cycle, pecks of a hole, passes of a thread: what goes beyond is a mistake. */
#define PROGRAM_REPEATS_MAX 10000
/* Moves, fillets and chamfers of the profile of G70 to G72. */
#ifndef PROGRAM_CONTOUR_MAX
#define PROGRAM_CONTOUR_MAX 80
#endif
/* Highest number of a digital and of an analogue input or output. */
#define PROGRAM_DIGITAL_MAX  31
#define PROGRAM_ANALOGUE_MAX 3
/* Warnings kept until they are fetched. */
#define PROGRAM_WARNINGS_MAX 4
/* '#... = ...' on one line. */
#define PROGRAM_ASSIGNMENTS_MAX 16
/*
 * Parameters the codes of one line set: G28.1 six, G92.1 and G38 seven, M66, a coordinate system
 * and M2 one each.
 */
#define PROGRAM_STORES_MAX 23
/* Values inside values: brackets, functions, parameters of parameters. Bounds the recursion. */
#define PROGRAM_NESTING_MAX 16

/* Numbered parameters are #1 ... #PARAMETER_NUMBER_MAX, as in LinuxCNC. */
#define PARAMETER_NUMBER_MAX 5601
/* #1 ... #30 always have a place. */
#define PARAMETERS_LOCAL 30
/* Others that are not 0. */
#ifndef PARAMETERS_MAX
#define PARAMETERS_MAX 1000
#endif
/* Named parameters, and the characters of a name. */
#ifndef PROGRAM_NAMES_MAX
#define PROGRAM_NAMES_MAX 96
#endif
#define PROGRAM_NAME_MAX 63

/* Open IF, WHILE, DO and REPEAT blocks, in all calls together. */
#define PROGRAM_BLOCKS_MAX 24
/* Calls inside calls. */
#define PROGRAM_CALLS_MAX 10
/* Subroutines and numbered programs of one text. */
#ifndef PROGRAM_SUBS_MAX
#define PROGRAM_SUBS_MAX 48
#endif
/*
 * Characters of all names in use, of parameters and O-words, each with one more. Here: as many as
 * they can be, of 31 each.
 */
#ifndef PROGRAM_TEXT_MAX
#define PROGRAM_TEXT_MAX ((PROGRAM_NAMES_MAX + PROGRAM_SUBS_MAX + PROGRAM_BLOCKS_MAX + 1) * 32)
#endif
/*
 * Numbers that calls keep for their ends: of #1 ... #30 those up to the last that is not 0, and
 * what M70 and M73 save. Here: as many as they can be.
 */
#ifndef PROGRAM_KEPT_MAX
#define PROGRAM_KEPT_MAX                                                                           \
    (PROGRAM_CALLS_MAX * PARAMETERS_LOCAL + (PROGRAM_CALLS_MAX + 1) * PROGRAM_SAVED_NUMBERS)
#endif
/* Largest number of an O-word. */
#define PROGRAM_LABEL_MAX 99999999
/*
 * Lines read again without a move in between that takes time, until the program is taken to run in
 * a circle. Fuzzing has less time.
 */
#ifndef PROGRAM_CIRCLE_LINES_MAX
#define PROGRAM_CIRCLE_LINES_MAX 1000000
#endif
/* Feed at which --from-line comes down when no F is known there. */
#define PROGRAM_APPROACH_FEED_MM_MIN 100.0

/* Largest P of an arc, and largest tool number of T and H. */
#define PROGRAM_TURNS_MAX 1000000
#define PROGRAM_TOOL_MAX  99999

#endif
