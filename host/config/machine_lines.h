/*
 * Where the keys of a machine stand in its files, so that what is wrong with a machine as a whole
 * is told at the key that it names.
 */
#ifndef TAKT_HOST_MACHINE_LINES_H
#define TAKT_HOST_MACHINE_LINES_H

#include "config/machine_keys.h"
#include "config/machine_setup.h"

#include <stdint.h>

struct machine_line {
    const char *file; /* NULL: the key stands in no file */
    uint32_t line, column;
};

struct machine_lines {
    struct machine_line at[MACHINE_KEYS_MAX][MACHINE_SETUP_DRIVES_MAX];
};

struct machine_line *machine_lines_find(struct machine_lines *lines, struct machine_place place,
                                        const struct machine_key *key);

/*
 * Tells what machine_setup_check has found: with the value of the first key that it names, and
 * where that stands; else of the file as a whole, NULL: there is none.
 */
void machine_lines_report(struct machine_lines *lines, struct machine_setup *setup,
                          const char *file, const char *wrong);

#endif
