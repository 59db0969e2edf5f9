/*
 * Concise configurations (CiA 302-3, object 1F22) of a machine's drives, as generators of CANopen masters write them: binary
 * files, named by dcf in [drive N].
 */
#ifndef TAKT_HOST_CONFIGURATION_FILE_H
#define TAKT_HOST_CONFIGURATION_FILE_H

#include "takt/machine_setup.h"

/* Reads those of this machine. False after a message. */
bool configuration_files_load(const struct machine_setup *setup);
/* Those that have been read last, as a controller takes them. */
const struct concise_dcf *configuration_files_get(void);

#endif
