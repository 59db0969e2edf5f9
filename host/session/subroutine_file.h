/*
 * Where a subroutine that a program calls is, if it is not in its text.
 */
#ifndef TAKT_HOST_SUBROUTINE_FILE_H
#define TAKT_HOST_SUBROUTINE_FILE_H

#include "session/program_front.h"

#include <stdbool.h>
#include <stddef.h>

/*
 * label: <name>, or a number without zeros before it. It is looked for beside the program, then in
 * the folders of --subroutines. False: there is no such file.
 */
bool subroutine_file_find(const struct program_front *front, const char *program, const char *label,
                          char *path, size_t size);

#endif
