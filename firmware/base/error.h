/*
 * One number line for errors: takt's own are negative, protocol codes (SDO aborts, Modbus exceptions) positive,
 * 0 is success. A broken invariant is not an error: it is an assert.
 */
#ifndef TAKT_BASE_ERROR_H
#define TAKT_BASE_ERROR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/*
 * Every error: its name and its text. In a text, %w stands for the offending word, %v for the value, with up to
 * six decimals. The numbers are the order of this list, from -1 down; append at the end of a group, the numbers
 * are not stored anywhere.
 */
#define TAKT_ERRORS(X)                                                                             \
    /* reading the text of a program */                                                            \
    X(SOURCE_UNREADABLE, "the program cannot be read")                                             \
    X(LINE_TOO_LONG, "the line is longer than %v characters")                                      \
    X(CHARACTER_UNKNOWN, "unexpected character '%w'")                                              \
    X(COMMENT_UNCLOSED, "a comment is not closed")                                                 \
    X(NUMBER_EXPECTED, "a number is missing after '%w'")                                           \
    X(WORD_UNKNOWN, "unknown word '%w'")                                                           \
    X(COMMENT_NESTED, "a comment opens inside a comment")                                          \
    X(WORD_REPEATED, "the word '%w' is given twice")                                               \
    X(WORD_UNUSED, "no code on this line uses the word '%w'")                                      \
    X(WORD_SHARED, "two codes on this line claim the word '%w'")                                   \
    X(WORD_NEGATIVE, "'%w' must not be negative: %v")                                              \
    X(WORD_NOT_WHOLE, "'%w' must be a whole number: %v")                                           \
    X(WORD_OUT_OF_RANGE, "'%w' is out of range: %v")                                               \
    X(WORDS_CONFLICT, "'%w' contradicts another word of its group on this line")                   \
    X(AXIS_MISSING, "the machine has no axis %w")                                                  \
    X(AXIS_WORD_MISSING, "'%w' needs an axis word")                                                \
    X(BRACKET_EXPECTED, "a '[' is missing after '%w'")                                             \
    X(BRACKET_UNCLOSED, "a '[' is not closed")                                                     \
    X(OPERATOR_EXPECTED, "an operator or ']' is missing after '%w'")                               \
    X(SLASH_EXPECTED, "ATAN needs two values: ATAN[y]/[x]")                                        \
    X(EQUALS_EXPECTED, "a '=' is missing after '%w'")                                              \
    X(NESTING_TOO_DEEP, "the expression is nested deeper than %v levels")                          \
    X(DIVISION_BY_ZERO, "division by zero")                                                        \
    X(CALCULATION_UNDEFINED, "%w is not defined for %v")                                           \
    X(CALCULATION_NOT_FINITE, "the result is too large")                                           \
    X(PARAMETER_NUMBER, "there is no parameter number %v")                                         \
    X(PARAMETER_NAME, "a parameter's name has 1 to %v characters and ends with '>'")               \
    X(PARAMETER_UNDEFINED, "the parameter '%w' has not been set")                                  \
    X(PARAMETER_READ_ONLY, "the parameter '%w' cannot be set by a program")                        \
    X(PARAMETERS_FULL, "no room for the parameter '%w'")                                           \
    X(ASSIGNMENTS_TOO_MANY, "more than %v assignments on one line")                                \
    /* motion */                                                                                   \
    X(ARC_ENDPOINT, "the arc's end is %v mm off its circle")                                       \
    X(FEED_MISSING, "a cutting move needs a feed: no F has been given")                            \
    X(TRAVEL_EXCEEDED, "axis %w would leave its travel: %v")                                       \
    X(MOTION_MODE_MISSING, "the word '%w' needs a motion code (G0, G1, G2 or G3)")                 \
    X(ARC_CENTRE_MISSING, "the arc's centre is missing: '%w' needs R, or I J K of its plane")      \
    X(ARC_CENTRE_TWICE, "the arc's centre is given twice: '%w' and I J K")                         \
    X(ARC_CENTRE_PARTIAL, "an absolute centre (G90.1) needs '%w' too")                             \
    X(ARC_RADIUS_ZERO, "the arc's centre is on its start or end")                                  \
    X(ARC_RADIUS_SMALL, "the arc's radius is %v mm too short to reach its end")                    \
    X(ARC_CLOSED, "an arc with R cannot end where it starts: give I J K for a full circle")        \
    X(MACHINE_COORDINATES, "'%w' works only with G0 or G1 and G90")                                \
    X(ROTATION_UNSUPPORTED,                                                                        \
      "the coordinate system '%w' is rotated by %v degrees, which is not supported")               \
    X(DWELL_MISSING, "'%w' needs P, the seconds to wait")                                          \
    X(TOOL_MISSING, "'%w' needs a tool: no T has been given")                                      \
    X(TOOL_UNKNOWN, "tool %v is not in the tool table: its length counts as 0")                    \
    X(SPINDLE_LIMITED, "'%w' is above the spindle's maximum of %v rev/min, which is used instead") \
    /* machine and drives */                                                                       \
    X(STARVED, "the planner could not keep up with the motion")                                    \
    X(DRIVE_FAULT, "the drive of axis %w reports a fault")                                         \
    X(DRIVE_SILENT, "the drive of axis %w does not answer")                                        \
    X(DRIVE_FOLLOWING, "axis %w lags %v mm behind its setpoint")                                   \
    X(DRIVE_RANGE, "%v mm is beyond the position range of the drive of axis %w")                   \
    X(DRIVE_UNREACHABLE, "the bus refused the setpoint of axis %w")

#define TAKT_ERROR_INDEX(name, text) TAKT_ERROR_INDEX_##name,
enum takt_error_index { TAKT_ERRORS(TAKT_ERROR_INDEX) TAKT_ERROR_TOTAL };
#undef TAKT_ERROR_INDEX

#define TAKT_ERROR_NUMBER(name, text) TAKT_ERROR_##name = -1 - (int)TAKT_ERROR_INDEX_##name,
enum takt_error { TAKT_OK = 0, TAKT_ERRORS(TAKT_ERROR_NUMBER) };
#undef TAKT_ERROR_NUMBER

#define DIAGNOSTIC_WORD_MAX 31
#define DIAGNOSTIC_TEXT_MAX 200

/* What went wrong, where: enough to print FILE:LINE:COLUMN: error: TEXT. */
struct diagnostic {
    enum takt_error code;
    uint32_t line;   /* from 1; 0: not of a line */
    uint32_t column; /* from 1; 0: the whole line */
    char word[DIAGNOSTIC_WORD_MAX + 1];
    double value;
};

/*
 * Fills d; word may be any length and need not end in zero. It is cut to DIAGNOSTIC_WORD_MAX bytes, never within
 * a UTF-8 character, and control characters become '?'.
 */
void diagnostic_set(struct diagnostic *d, enum takt_error code, uint32_t line, uint32_t column,
                    const char *word, size_t word_length, double value);

/*
 * The text of d without file, line and column ("the arc's end is 0.031 mm off its circle"), zero-terminated,
 * in text[DIAGNOSTIC_TEXT_MAX]. Returns its length. A code outside the list reads "error CODE".
 */
size_t diagnostic_text(const struct diagnostic *d, char *text);

#endif
