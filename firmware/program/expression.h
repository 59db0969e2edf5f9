/*
 * Values: numbers, parameters, functions and expressions in brackets, read and worked out in one
 * pass.
 *
 *     value      = { '+' | '-' } ( number | '[' expression ']' | function | reference )
 *     expression = value { operator value }
 *     function   = NAME '[' expression ']' | ATAN '[' expression ']' '/' '[' expression ']'
 *                | EXISTS '[' reference ']'
 *     reference  = '#' value | '#' '<' name '>'
 */
#ifndef TAKT_PROGRAM_EXPRESSION_H
#define TAKT_PROGRAM_EXPRESSION_H

#include "program/program.h"

/* Reads a value from the line. It is finite. False: p->error is set. */
bool takt_expression_read(struct program *p, double *value);

/* Reads a reference; '#' is read already. The number is checked, a name need not be known. */
bool takt_expression_read_reference(struct program *p, struct program_reference *reference);

/* The parameter of a name that has been set, or a predefined one. False: there is none. */
bool takt_expression_find_named(const struct program *p, const char *name, size_t length,
                                double *value);

/*
 * The nearest integer to value when it is within 0.0001 of it, as for all values that must be
 * whole.
 */
bool takt_expression_whole(double value, double *whole);

#endif
