/*
 * Files of the computer whose names stand on the line that an image was started with.
 */
#ifndef TAKT_SEMIHOSTING_FILES_H
#define TAKT_SEMIHOSTING_FILES_H

#include "semihosting/semihosting.h"

#include <stdbool.h>
#include <stddef.h>

#define FILES_LINE_MAX 256

struct files {
    char words[FILES_LINE_MAX];
    char *rest;
};

/* False: there is no such line. The first word is the image's own. */
bool takt_files_begin(struct files *files);

/*
 * The handle of the file that the next word names; -1: there is no further word, or no such file.
 */
int takt_files_open_next(struct files *files, enum semihosting_mode mode);

/* All of size bytes; a pipe may give them in pieces. False: it has ended. */
bool takt_files_read_all(int file, void *bytes, size_t size);

#endif
