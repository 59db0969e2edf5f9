/*
 * What one control cycle did: the row of a trace.
 */
#ifndef TAKT_MOTION_CYCLE_RECORD_H
#define TAKT_MOTION_CYCLE_RECORD_H

#include "base/point.h"

#include <stdbool.h>
#include <stdint.h>

struct cycle_record {
    uint64_t cycle;          /* from 0, the first program cycle */
    uint32_t block;          /* motion being executed, from 1; 0 before the first */
    uint32_t line;           /* of the part program */
    double feed_mm_s;        /* along the path, this cycle */
    double override_percent; /* effective feed override */
    double limiter;          /* axis velocity limiter K, 1 = not acting */
    struct point cmd;        /* setpoint before correction, mm or rad */
    struct point set;        /* setpoint sent to the drives */
    struct point act;        /* last position the drives reported */
    double spindle_rev;      /* measured at the start of the cycle */
    bool landed;             /* this cycle ends its block exactly: cmd is the block's end */
};

#endif
