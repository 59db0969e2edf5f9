/*
 * Tool tables in LinuxCNC's .tbl form: one tool a line, a letter and a number per word, ';' begins
 * a comment.
 *
 *     T1 P1 Z50.8 D6.35 ; end mill
 *
 * T: number. X Y Z A B C: offsets, mm and degrees. D: diameter, mm. I, J: front and back angle,
 * degrees, and Q: orientation, of lathe tools. P (pocket) and U V W must be numbers and are not
 * used.
 */
#ifndef TAKT_HOST_TOOL_FILE_H
#define TAKT_HOST_TOOL_FILE_H

#include "program/tools.h"

#include <stdbool.h>

struct tool_file {
    struct tool_table table;
    struct tool *tools; /* owned; what table points to */
};

/* False after messages, one for every error; then nothing is to be closed. */
bool tool_file_read(struct tool_file *file, const char *path);
void tool_file_close(struct tool_file *file);

#endif
