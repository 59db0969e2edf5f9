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
    /* flow of a program */                                                                        \
    X(OWORD_LABEL, "'%w' needs a whole number, or a <name> of up to %v characters")                \
    X(OWORD_UNKNOWN, "there is no O-word '%w'")                                                    \
    X(OWORD_ALONE, "'%w' must stand alone on its line")                                            \
    X(OWORD_UNMATCHED, "'%w' belongs to no open block of its kind and label")                      \
    X(OWORD_CROSSED, "'%w' stands inside another block, opened in line %v and not closed")         \
    X(OWORD_LABEL_USED, "'%w' has the label of an open block, of line %v")                         \
    X(OWORD_UNCLOSED, "'%w' is not closed")                                                        \
    X(OWORD_TOO_DEEP, "'%w' is nested deeper than %v blocks")                                      \
    X(SUB_UNKNOWN, "'%w' finds no such subroutine in this program")                                \
    X(SUB_DEFINED_TWICE, "'%w' has been defined already, in line %v")                              \
    X(SUB_NESTED, "'%w' begins inside another subroutine")                                         \
    X(SUB_NOT_INSIDE, "'%w' is not inside its subroutine")                                         \
    X(SUB_STYLE,                                                                                   \
      "'%w' mixes O... sub, which goes with call, and a bare O..., which goes with M98")           \
    X(SUBS_TOO_MANY, "'%w' is more than the %v subroutines a program can have")                    \
    X(CALL_TOO_DEEP, "'%w' is a call inside more than %v others")                                  \
    X(CALL_ARGUMENTS, "'%w' has more than %v arguments")                                           \
    X(CALL_P_MISSING, "'%w' needs P, the number of the program to call")                           \
    X(JUMP_BACK, "'%w' has to go back in the text, which a stream cannot")                         \
    X(CIRCLE, "the program runs in a circle: %v lines without a move")                             \
    X(MODES_NOT_SAVED, "'%w' finds no saved modes: no M70 or M73 in this call")                    \
    X(FROM_LINE_MISSED, "the program never comes to line %v")                                      \
    X(FROM_LINE_PROBE, "what this probing move finds is not known to a start at line %v")          \
    X(FROM_LINE_CUTTER, "line %v is inside a compensated contour: start before its G41 or G42")    \
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
    X(ARC_TILTED, "'%w' works only in G17 while the coordinate system is rotated (by %v degrees)") \
    X(SPINDLE_STANDS, "'%w' needs a turning spindle: M3 or M4, and S above 0")                     \
    X(SPINDLE_WRONG_WAY, "'%w' needs the spindle to turn the other way")                           \
    X(SPINDLE_FOLLOWED, "'%w' moves at the commanded spindle speed: the spindle is not measured")  \
    X(WORD_MISSING, "this code needs the word '%w'")                                               \
    X(WORD_ZERO, "'%w' must not be 0")                                                             \
    X(WORD_NOT_POSITIVE, "'%w' must be above 0: %v")                                               \
    X(FEED_MODE_UNFIT, "'%w' does not work in this feed mode: use G94")                            \
    X(CYCLE_UPSIDE_DOWN, "the bottom of '%w' is %v mm above its R")                                \
    X(CYCLE_TOO_LONG, "'%w' would repeat itself more than %v times")                               \
    X(THREAD_DEPTH, "the depth of the thread, '%w', must be above that of the first cut, J")       \
    X(SPLINE_UNSUPPORTED, "'%w': splines are not supported; use lines and arcs")                   \
    X(INVOLUTE_START, "the start is %v mm inside the involute's base circle")                      \
    X(INVOLUTE_END, "the end is %v mm off the involute")                                           \
    X(INVOLUTE_CLOSED, "start and end are equally far from the centre of the involute '%w'")       \
    X(INVOLUTE_UNPLANNED, "involutes can be read and printed, but not yet run or planned")         \
    X(PROBE_NO_WAY, "the probing move '%w' ends where it starts")                                  \
    X(PROBE_NO_CONTACT, "the probing move ended without the probe's answer")                       \
    X(SETTING_MISSING, "'%w' has no word to set anything")                                         \
    X(TOOL_ABSENT, "tool %v is not in the tool table")                                             \
    X(TOOL_CHANGES_FULL, "a program can change the values of %v tools at most")                    \
    X(CUTTER_REPEATED, "'%w': cutter compensation is on already; G40 comes first")                 \
    X(CUTTER_DIAMETER, "'%w' needs D, the diameter of the tool")                                   \
    X(CUTTER_ORIENTATION, "'%w': compensation for lathe tools (orientation %v) is not supported")  \
    X(CUTTER_ON, "'%w' is not possible while cutter compensation is on")                           \
    X(CUTTER_EXIT_ARC, "the first move after cutter compensation must be straight, not '%w'")      \
    X(OFFSET_ENTRY_SHORT,                                                                          \
      "the entry move is too short for the tool's radius: it must be more than %v mm longer")      \
    X(OFFSET_ENTRY_ARC, "no arc leads from here to the compensated end of the entry move")         \
    X(OFFSET_ARC_SMALL,                                                                            \
      "the tool does not fit into the arc: its radius would have to be more than %v mm larger")    \
    X(OFFSET_GOUGE, "the tool does not fit here: it would cut %v mm into the contour")             \
    X(OFFSET_LEFT_OUT, "this move is left out: the tool, radius %v mm, does not get there")        \
    X(OFFSET_CROWDED, "more than %v commands between two moves of a compensated contour")          \
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
