/*
 * Numbered parameters as a program sees them: the stored ones, and those that say how things stand.
 */
#ifndef TAKT_PROGRAM_SYSTEM_PARAMETERS_H
#define TAKT_PROGRAM_SYSTEM_PARAMETERS_H

#include "program/program.h"

/* number: 1 ... PARAMETER_NUMBER_MAX. */
double takt_system_parameter_get(const struct program *p, unsigned number);

/* True for the computed ones, which programs cannot set. */
bool takt_system_parameter_is_read_only(unsigned number);

#endif
