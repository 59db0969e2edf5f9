/*
 * The relay test of a drive in its mode of torque: what its loops are does not matter.
 */
#ifndef TAKT_HOST_TUNE_RELAY_H
#define TAKT_HOST_TUNE_RELAY_H

#include "machine/machine.h"
#include "studies/tune_drive.h"
#include "studies/tune_test.h"

/*
 * Moves the axis and says what moves. NULL: plant, relay, torque_nm, low, high of it are set; else
 * what is wrong.
 */
const char *tune_relay_run(struct tune_axis *result, struct tune_drive *drive,
                           const struct machine_axis *axis);

#endif
