/*
 * What is to be measured by a calibration: inputs, outputs and knots of its table, as options say.
 */
#ifndef TAKT_HOST_CALIBRATION_TASK_H
#define TAKT_HOST_CALIBRATION_TASK_H

#include "cli/options.h"
#include "studies/calibration.h"

/*
 * Its session is open. False after a message: that cannot be measured, or the machine could not use
 * it.
 */
bool calibration_set(struct calibration *c, const struct options *options);

/*
 * Whether the machine can use the table, whose numbers may have become too large. False after a
 * message.
 */
bool calibration_check(const struct calibration *c);

/* AXIS_COUNT: it is the letter of none. */
uint8_t calibration_axis_named(const char *name);

#endif
