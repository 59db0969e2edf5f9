/*
 * A correction table of the virtual machine: every row of it is visited and measured, or composed
 * of what is known.
 */
#ifndef TAKT_HOST_CALIBRATION_H
#define TAKT_HOST_CALIBRATION_H

#include "correction/correction.h"
#include "session/session.h"
#include "studies/measurement.h"

/* Everything a calibration works with. */
struct calibration {
    struct session session;
    struct table table;
    struct measurement_visit *visits; /* of every row first from below, then from above */
    struct measurement_instrument instrument;
};

/*
 * Measures all rows of the table, or composes them of the errors of the units; without a message
 * only STATUS_DONE.
 */
enum command_status calibration_fill(struct calibration *c, bool composes);

void calibration_close(struct calibration *c);

#endif
