/*
 * The values of tools as the program sees them: of the tool table, or what G10 has made of them
 * since. What G10 changes lasts until the end of the program.
 */
#ifndef TAKT_PROGRAM_TOOL_VALUES_H
#define TAKT_PROGRAM_TOOL_VALUES_H

#include "program/program.h"

/* NULL when there is no such tool. */
const struct tool *takt_tool_values_find(const struct program *p, uint32_t number);

/*
 * The tool for the code of a step to change; takt_tool_values_take_back undoes what one line
 * changes. NULL: p->error is set.
 */
struct tool *takt_tool_values_change(struct program *p, enum step step, uint32_t number);

/* Before each line, and after one with an error. */
void takt_tool_values_begin_line(struct program *p);
void takt_tool_values_take_back(struct program *p);
/* After one that counts (changes.h). */
void takt_tool_values_note_changes(struct program *p);

#endif
