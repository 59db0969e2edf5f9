/*
 * One fault, tried: the real controller runs a program on three virtual drives and the embedded
 * bus, the fault script takes effect, and everything goes on until nothing moves any more.
 */
#ifndef TAKT_TESTS_FAULT_RUN_H
#define TAKT_TESTS_FAULT_RUN_H

#include "base/error.h"

#include <stdbool.h>

/* Three drives, and what is special. */
enum fault_machine {
    FAULT_PLAIN,
    FAULT_HOMED,   /* X looks for its limit switch at start */
    FAULT_WITH_IO, /* there is an I/O node, 4: its inputs are stop, limit and P0 */
    FAULT_GANTRY,  /* Y has a second drive, node 4 */
    FAULT_GUARDED  /* no drive has a heartbeat: all are guarded */
};

struct fault_case {
    const char *name;
    const char *script; /* as `takt help inject` says; drives are nodes 1, 2, 3 of X, Y, Z */
    enum fault_machine machine;

    /* What is to come of it. */
    enum takt_error alarm; /* TAKT_OK: the program is run to its end */
    const char
        *text; /* what the alarm begins with: up to the first figure that depends on the motion */
    double stop_max_ms; /* from the fault to rest; of a program that goes on it is not looked at */
    double off_max_mm;  /* distance from the programmed path, from the fault on */
};

struct fault_result {
    bool completed;
    struct diagnostic alarm;
    char text[DIAGNOSTIC_TEXT_MAX]; /* empty: no alarm */
    double alarm_ms;                /* from the fault to the alarm */
    double stop_ms;                 /* from the fault to the last cycle in which an axis moved */
    double off_mm;   /* farthest of the tool from the path, by the motors' true positions */
    double end_mm_s; /* velocity of the fastest axis when everything is over */
};

extern const struct fault_case fault_cases[];
extern const unsigned fault_cases_count;

/* False: the script cannot be read; result->text says why. */
bool fault_run(const struct fault_case *fault, struct fault_result *result);

#endif
