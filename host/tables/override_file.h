/*
 * The files of --override and --rapid-override: what the operator turns the override to, and when.
 *
 *     # time from the first program cycle, and per cent; each holds until the next
 *     0    100
 *     2.5   50
 */
#ifndef TAKT_HOST_OVERRIDE_FILE_H
#define TAKT_HOST_OVERRIDE_FILE_H

#include <stdbool.h>
#include <stddef.h>

struct override_row {
    double time_s; /* >= 0, rising */
    double percent;
};

struct override_file {
    struct override_row *row;
    size_t count;
    size_t next; /* the first row whose time has not come */
    double percent;
};

/*
 * path NULL: 100 per cent throughout. percent_max: the highest that is accepted. False after a
 * message.
 */
bool override_file_load(struct override_file *file, const char *path, double percent_max);
void override_file_free(struct override_file *file);

/* What holds at a time; times must not fall from call to call. */
double override_file_at(struct override_file *file, double time_s);

#endif
