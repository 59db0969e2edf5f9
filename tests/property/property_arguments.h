/* The arguments of a property test: how many cases, and the first seed. */
#ifndef TAKT_TEST_PROPERTY_ARGUMENTS_H
#define TAKT_TEST_PROPERTY_ARGUMENTS_H

#include <stdlib.h>

/* NUMBER, where it is given. */
static inline void read_number(int argc, char **argv, unsigned *number)
{
    if (argc > 1) {
        *number = (unsigned)strtoul(argv[1], NULL, 10);
    }
}

/* NUMBER and FIRST, where they are given. */
static inline void read_number_and_first(int argc, char **argv, unsigned *number, unsigned *first)
{
    read_number(argc, argv, number);
    if (argc > 2) {
        *first = (unsigned)strtoul(argv[2], NULL, 10);
    }
}

#endif
