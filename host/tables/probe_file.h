/*
 * The file of --probe: what the virtual machine touches and is told.
 */
#ifndef TAKT_HOST_PROBE_FILE_H
#define TAKT_HOST_PROBE_FILE_H

#include "probe/virtual_probe.h"

#include <stdbool.h>

/* path NULL: nothing is touched, all inputs are 0. False after a message. */
bool probe_file_load(struct virtual_probe *probe, const char *path);

#endif
