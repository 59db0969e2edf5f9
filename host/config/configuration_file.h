/*
 * Concise configurations (CiA 302-3, object 1F22) of a machine's drives, as generators of CANopen
 * masters write them: binary files, named by dcf in [drive N].
 */
#ifndef TAKT_HOST_CONFIGURATION_FILE_H
#define TAKT_HOST_CONFIGURATION_FILE_H

#include "canopen/concise_dcf.h"
#include "cli/text.h"
#include "config/machine_setup.h"

/* A machine's; it has no more drives than there are places. All zero: none. */
struct configuration_files {
    struct text text[MACHINE_SETUP_DRIVES_MAX];
    struct concise_dcf dcf[MACHINE_SETUP_DRIVES_MAX]; /* as a controller takes them */
};

/* Reads those of this machine. False after a message; they are to be freed in either case. */
bool configuration_files_load(struct configuration_files *files, const struct machine_setup *setup);
void configuration_files_free(struct configuration_files *files);

#endif
