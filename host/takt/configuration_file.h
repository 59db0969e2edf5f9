/*
 * Concise configurations (CiA 302-3, object 1F22) of a machine's drives, as generators of CANopen masters write them: binary
 * files, named by dcf in [drive N].
 */
#ifndef TAKT_HOST_CONFIGURATION_FILE_H
#define TAKT_HOST_CONFIGURATION_FILE_H

#include "takt/machine_setup.h"

/* Reads them and hands them to the machine, for as long as the process lives. False after a message. */
bool configuration_files_load(struct machine_setup *setup);

#endif
