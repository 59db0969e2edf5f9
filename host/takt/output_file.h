/*
 * An output file that is whole or not there: written beside its place, then renamed.
 *
 * "-" is standard output, and things that are no regular file (/dev/null, a pipe) are written straight.
 */
#ifndef TAKT_HOST_OUTPUT_FILE_H
#define TAKT_HOST_OUTPUT_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#define OUTPUT_PATH_MAX 4096

struct output_file {
    FILE *stream; /* NULL: not open */
    char path[OUTPUT_PATH_MAX];
    char aside[OUTPUT_PATH_MAX + 16]; /* empty: written straight */
};

/* False after a message: it cannot be created. */
bool output_file_open(struct output_file *file, const char *path);
/* Ends the file and puts it in its place. False after a message: not everything could be written; nothing is left
 * in its place. */
bool output_file_commit(struct output_file *file);
/* Gives it up: no trace is left. Nothing happens when it is not open. */
void output_file_discard(struct output_file *file);

#endif
