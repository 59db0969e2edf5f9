/*
 * A test of a real drive's torque, as its maker's tool or an oscilloscope has recorded it: rows of
 * torque and position.
 */
#ifndef TAKT_HOST_TUNE_RECORD_H
#define TAKT_HOST_TUNE_RECORD_H

#include "studies/tune_drive.h"
#include "studies/tune_test.h"

/*
 * Rows by control cycle: torque Nm from there on, position mm (rotary: deg). False after a message.
 */
bool tune_record_read(struct tuning_record *record, const char *path, bool is_rotary);

/*
 * What it moves, by result->relay; the virtual drive is given the same to move, so that its loops
 * can be tried on it. NULL; else what is wrong.
 */
const char *tune_record_use(struct tune_axis *result, struct tune_drive *drive, double step_s);

#endif
