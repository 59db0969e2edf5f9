/*
 * Machine files: INI text, read with inih.
 */
#ifndef TAKT_HOST_MACHINE_FILE_H
#define TAKT_HOST_MACHINE_FILE_H

#include "cli/options.h"
#include "config/machine_setup.h"

#include <stdbool.h>
#include <stdio.h>

/*
 * Reads a machine file over *setup, which holds the built-in machine. A file that names an axis has
 * the axes it names and no others. False after messages, one for every error.
 */
bool machine_file_read(struct machine_setup *setup, const char *path);

/*
 * Applies "section.key=value" or "section.instance.key=value" as --set gives it. False after a
 * message.
 */
bool machine_file_assign(struct machine_setup *setup, const char *assignment);

/*
 * The machine a command is to use: built in, file, --with, --set in their order, checked as a
 * whole. False after messages.
 */
bool machine_file_load(struct machine_setup *setup, const struct options *options);

/* Writes a complete, commented machine file that reads as *setup. */
void machine_file_write(FILE *file, const struct machine_setup *setup);

#endif
