/*
 * The files that a command reads, so that none of them is written over by what it writes: see
 * output_file.h. Known by what they are, whatever links lead to them.
 */
#ifndef TAKT_HOST_FILES_READ_H
#define TAKT_HOST_FILES_READ_H

#include <stdbool.h>

/* From now on this thread notes what it reads; what it read before is forgotten. */
void files_read_begin(void);
/* path: is read, or will be. Nothing happens when it is no regular file. */
void files_read_note(const char *path);
bool files_read_has(const char *path);

#endif
