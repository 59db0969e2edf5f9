/*
 * Parameters in LinuxCNC's .var form: a number and its value a line, separated by spaces or tabs.
 */
#ifndef TAKT_HOST_PARAMETER_FILE_H
#define TAKT_HOST_PARAMETER_FILE_H

#include "program/parameters.h"

#include <stdbool.h>
#include <stdio.h>

struct parameter_file {
    struct parameters values;
    bool listed[PARAMETER_NUMBER_MAX + 1]; /* numbers the file names: they are saved even when 0 */
};

/* False after messages, one for every error. */
bool parameter_file_read(struct parameter_file *file, const char *path);

/*
 * Writes what is kept between programs: the numbers the file listed, and of the persistent ones
 * (#PARAMETER_REFERENCE_1 and up, without those that are computed) all that are not 0.
 */
void parameter_file_write(FILE *stream, const struct parameter_file *file);

#endif
