/*
 * Virtual drives for a master outside of the process: which ones, of what machine or data sheet,
 * and what befalls them.
 */
#ifndef TAKT_HOST_OUTSIDE_DRIVE_SETUP_H
#define TAKT_HOST_OUTSIDE_DRIVE_SETUP_H

#include "cli/options.h"
#include "config/data_sheet.h"
#include "config/machine_setup.h"
#include "drives/virtual_drives.h"
#include "inject/inject.h"
#include "probe/virtual_probe.h"

#include <stdbool.h>

struct drive_setup {
    const struct options *options;
    struct machine_setup machine;
    struct virtual_drives_config drives;
    struct dictionary sheet[DATA_SHEETS_MAX]; /* of the machine's drives that have one */
    struct dictionary given;                  /* --eds with --bus: of all drives */
    struct inject script;
    struct virtual_probe probe;
};

/* All zeros before. False after messages. */
bool drive_setup_read(struct drive_setup *setup, const struct options *options);

#endif
