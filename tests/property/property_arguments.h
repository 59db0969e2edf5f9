/* The arguments of a property test: how many cases, and the first seed. */
#ifndef TAKT_TEST_PROPERTY_ARGUMENTS_H
#define TAKT_TEST_PROPERTY_ARGUMENTS_H

#include <stdlib.h>

/* NUMBER and FIRST, where they are given. */
static void read_number_and_first(int argc, char **argv, unsigned *number, unsigned *first)
{
    if (argc > 1) {
        *number = (unsigned)strtoul(argv[1], NULL, 10);
    }
    if (argc > 2) {
        *first = (unsigned)strtoul(argv[2], NULL, 10);
    }
}

#endif
