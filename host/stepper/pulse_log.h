/*
 * Log of the pulses of step drives, for viewers of logic analysers: every edge at its nanosecond
 * since power-on.
 *
 *     VCD (value change dump, IEEE 1364-2005, clause 18)     CSV: a row for each pulse, a column for each axis
 *         X_step   __|^^|______|^^|___                           time_s,X,Y,Z
 *         X_dir    ^^^^^^^^^^^^|______   1: forwards             1.000012345,1,0,-1
 *
 * A pulse has no length in hal/step.h. Here a step line is high for half of the shortest time
 * between two steps of its drive, so that it has fallen when the next one comes; its direction
 * changes with the edge.
 */
#ifndef TAKT_HOST_PULSE_LOG_H
#define TAKT_HOST_PULSE_LOG_H

#include "hal/step.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

enum pulse_log_form { PULSE_LOG_CSV, PULSE_LOG_VCD };

/* By the end of a file's name, .csv or .vcd; "-" is CSV. False: it is neither. */
bool pulse_log_form_of(const char *path, enum pulse_log_form *form);

struct pulse_log_config {
    enum pulse_log_form form;
    unsigned axes;                  /* bit i: axis i is a step drive */
    double rate_max_hz[AXIS_COUNT]; /* of its steps; > 0, at most 1e8 */
};

struct pulse_log {
    FILE *stream; /* the caller's */
    struct pulse_log_config config;
    uint64_t falls_ns[AXIS_COUNT]; /* of its step line; UINT64_MAX: it is low */
    unsigned backwards;            /* bit i: axis i goes backwards, as written */
    uint64_t now_ns;               /* newest time written */
};

/* Writes the head. */
void pulse_log_begin(struct pulse_log *log, FILE *stream, const struct pulse_log_config *config);

/* A pulse, not earlier than the one before. Has the form of virtual_steppers_listener. */
void pulse_log_take(void *log, uint64_t time_ns, const struct step_pulse *pulse);

/* The last edges. False: this or an earlier write has failed. */
bool pulse_log_end(struct pulse_log *log);

bool pulse_log_has_failed(const struct pulse_log *log);

#endif
