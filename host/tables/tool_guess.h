/*
 * A tool table made of what a program says of its tools itself: --tools auto.
 *
 *     (T1 D=6. CR=0. - ZMIN=-3 - flat end mill)      tool 1, 6 mm, or inch in a program with G20
 *     T2 M6 ... G41 D3                               tools 2 and 3, of diameter 0
 */
#ifndef TAKT_HOST_TOOL_GUESS_H
#define TAKT_HOST_TOOL_GUESS_H

#include "cli/program_text.h"
#include "tables/tool_file.h"

#include <stdbool.h>

/*
 * Fills an empty file, with a warning that says what it is. False after a message: out of memory.
 */
bool tool_guess(struct tool_file *file, const struct program_text *text);

#endif
