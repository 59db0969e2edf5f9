/*
 * What in a program is right and yet hardly meant: rules over its canonical moves, its lines and
 * its planned blocks. What stands in the program's comments or the machine file is not asked.
 */
#ifndef TAKT_HOST_LINT_H
#define TAKT_HOST_LINT_H

#include "session/session.h"

/* A height in mm as --stock-top has it; NULL: 0. False after a message. */
bool lint_read_top(const char *text, double *top_mm);

/* Looks at a program that has been checked, and prints what it finds. *findings: how many. */
enum command_status lint_program(const struct session *s, double stock_top_mm, unsigned *findings);

#endif
