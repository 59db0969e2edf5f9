/*
 * An output file that is whole or not there: written beside its place, brought to the disk, then
 * renamed. So neither a signal nor a power cut leaves a part of it: what was there before stays.
 * Finish all files of a command before the first is placed, so that all are there or none.
 *
 * "-" is standard output, and things that are no regular file (/dev/null, a pipe) are written
 * straight. What a command reads (files_read.h) it does not write over.
 */
#ifndef TAKT_HOST_OUTPUT_FILE_H
#define TAKT_HOST_OUTPUT_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#define OUTPUT_PATH_MAX 4096

struct output_file {
    FILE *stream;  /* NULL: not open */
    bool replaces; /* a file that is read, as was asked for */
    char path[OUTPUT_PATH_MAX];
    char aside[OUTPUT_PATH_MAX + 16]; /* empty: written straight */
};

/* False after a message: it cannot be created. */
bool output_file_open(struct output_file *file, const char *path);
/* The same, and the path may be that of `over`, which is read; NULL: of none. */
bool output_file_replace(struct output_file *file, const char *path, const char *over);
/* For files that are opened by other means. False after a message: the path is one that is read. */
bool output_file_may_write(const char *path);
/*
 * False after a message: two options of a command name the same file, or both standard output.
 * path: of each option, NULL where it is not given.
 */
bool output_file_differ(const char *const option[], const char *const path[], unsigned count);
/* Ends the file. False after a message: not everything could be written; it is given up. */
bool output_file_finish(struct output_file *file);
/* True after a message that names it: something could not be written to it so far. */
bool output_file_tell_failed(struct output_file *file);
/* Puts a finished file in its place. False after a message: nothing has changed there. */
bool output_file_place(struct output_file *file);
/* Gives it up: no trace is left. Nothing happens when it is not open. */
void output_file_discard(struct output_file *file);

#endif
