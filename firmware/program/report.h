/*
 * How the interpreter says what is wrong with the current line.
 */
#ifndef TAKT_PROGRAM_REPORT_H
#define TAKT_PROGRAM_REPORT_H

#include "program/program.h"

/*
 * Sets p->error about a piece of the line, named in capitals. Returns false, for its caller to
 * return.
 */
bool takt_report_error(struct program *p, enum takt_error code, struct program_span span,
                       double value);

/* The same about one character; at its end the line is meant as a whole. */
bool takt_report_error_at(struct program *p, enum takt_error code, unsigned at, double value);

/* The same about the code of a step, and about the value's letter, in lower case. */
bool takt_report_error_code(struct program *p, enum takt_error code, enum step step, double value);
bool takt_report_error_letter(struct program *p, enum takt_error code, char letter, double value);

/* About a word that the code of a step needs and the line does not have; letter in lower case. */
bool takt_report_missing(struct program *p, enum step step, char letter);

/* Adds a warning, for takt_program_warning; dropped when there are too many. */
void takt_report_warning(struct program *p, enum takt_error code, struct program_span span,
                         double value);

#endif
