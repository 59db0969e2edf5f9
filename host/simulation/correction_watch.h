/*
 * What position-error correction did in a run: the largest correction of each axis, and what
 * following it cost in velocity, acceleration and jerk, by differences of what was added to the
 * setpoints.
 */
#ifndef TAKT_HOST_CORRECTION_WATCH_H
#define TAKT_HOST_CORRECTION_WATCH_H

#include "controller/controller.h"
#include "motion/cycle_record.h"

#include <stdint.h>

struct correction_watch {
    double rate_hz;
    unsigned present;  /* bit i: layer i had something to correct */
    unsigned reported; /* bit i: axis i was beyond the end of a table, and a warning said so */
    double k_mm[AXIS_COUNT], v_mm_s[AXIS_COUNT], a_mm_s2[AXIS_COUNT]; /* of the last cycle */
    double max_mm[AXIS_COUNT];
    double max_velocity_mm_s[AXIS_COUNT];
    double max_acceleration_mm_s2[AXIS_COUNT];
    double max_jerk_mm_s3[AXIS_COUNT];
};

void correction_watch_init(struct correction_watch *w, double cycle_s);

/* After every program cycle. program: its name, for the warning when an axis leaves a table. */
void correction_watch_add(struct correction_watch *w, struct correction *correction,
                          const struct cycle_record *record, const char *program);

#endif
