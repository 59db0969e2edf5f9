/*
 * What expressions can calculate: operators and functions, by their names in the text.
 */
#ifndef TAKT_PROGRAM_CALCULATION_H
#define TAKT_PROGRAM_CALCULATION_H

#include "base/error.h"

/* Operators that bind tighter come later; those of one level are done from left to right. */
enum operation_level {
    LEVEL_END, /* ']' */
    LEVEL_LOGIC,
    LEVEL_COMPARISON,
    LEVEL_SUM,
    LEVEL_PRODUCT,
    LEVEL_POWER,
    LEVEL_COUNT
};

struct operation_entry {
    char name[4];
    unsigned char length;
    enum operation_level level;
    /* TAKT_OK or what is wrong with the operands, which are finite; the result need not be. */
    enum takt_error (*apply)(double left, double right, double *result);
};

/* The operator text begins with; NULL when there is none. */
const struct operation_entry *takt_operation_find(const char *text);

struct function_entry {
    char name[8];
    unsigned char length;
    /*
     * TAKT_OK or what is wrong with the argument; NULL for ATAN and EXISTS, which are read in their
     * own way.
     */
    enum takt_error (*apply)(double x, double *result);
};

/* The function text begins with; NULL when there is none. */
const struct function_entry *takt_function_find(const char *text);

/* ATAN[y]/[x] in degrees, -180 ... 180. */
double takt_calculation_atan(double y, double x);

#endif
