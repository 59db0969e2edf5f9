/*
 * Named parameters that are there without being set and say how things stand: #<_feed>, #<_x> ...
 */
#ifndef TAKT_PROGRAM_PREDEFINED_H
#define TAKT_PROGRAM_PREDEFINED_H

#include "program/program.h"

/* False when there is none of that name, which need not end in zero. */
bool takt_predefined_get(const struct program *p, const char *name, size_t length, double *value);

#endif
