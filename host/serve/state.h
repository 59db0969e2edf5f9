/*
 * What a service keeps over power-off, as text:
 *
 *     takt-state 1
 *     machine NAME
 *     base TOOLS PARAMETERS             checksums of what the files said when it was written
 *     program SIZE CRC LINE             what CYCLE_START starts, and where it was cut short; LINE 0: nowhere
 *     parameter NUMBER VALUE
 *     tool NUMBER ORIENTATION X Y Z A B C DIAMETER FRONT BACK
 *     wear TOOL LENGTH TIME
 *     setup X Y Z I J K R X Y Z I J K R set-up of the part, and that of the machine file when it was written
 *
 * mm, rad, s; numbers with as many digits as give the same bits again. Lines of a name that this
 * version does not know are skipped, so a later version may add some; one that changes their
 * meaning raises the number in the first line.
 */
#ifndef TAKT_SERVE_STATE_H
#define TAKT_SERVE_STATE_H

#include "correction/settings.h"
#include "program/parameters.h"
#include "program/tools.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define STATE_VERSION     1
#define STATE_NAME_MAX    127
#define STATE_WEARS_MAX   64
#define STATE_PROBLEM_MAX 127

struct state_wear {
    uint32_t tool;
    double length_mm, time_s;
};

struct state {
    char machine[STATE_NAME_MAX + 1];
    uint32_t tools_base, parameters_base;
    uint32_t program_size, program_crc, line;
    struct parameters parameters;
    struct state_wear wear[STATE_WEARS_MAX];
    size_t wears;
    double setup[2 * CORRECTION_SETUP_VALUES]; /* and then that of the machine file */
    bool has_setup;
    struct tool *tools; /* room for tools_max of them; the caller's */
    size_t tools_count, tools_max;
};

/* The text, to be freed by free(); NULL: out of memory. */
char *state_write(const struct state *state, size_t *length);

/*
 * False: problem says what is wrong with the text, and *state is of no use. tools and tools_max are
 * set before.
 */
bool state_read(struct state *state, const char *text, size_t length,
                char problem[STATE_PROBLEM_MAX + 1]);

/* Checksums of what a file has said, to find out whether it has changed since. */
uint32_t state_sum_tools(const struct tool *tools, size_t count);
uint32_t state_sum_parameters(const struct parameters *parameters);

#endif
