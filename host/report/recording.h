/*
 * What a report remembers of a run: thinned series over time and the thinned tool path.
 * Units are those of the edge: mm/min along the path, degrees for rotary axes.
 */
#ifndef TAKT_REPORT_RECORDING_H
#define TAKT_REPORT_RECORDING_H

#include "drive/drives.h"
#include "motion/cycle_record.h"
#include "plan/limits.h"
#include "report/thin.h"
#include "report/trail.h"

#include <stdbool.h>
#include <stdint.h>

/* Series of the run as a whole, then those of every axis in turn. */
enum run_series { RUN_FEED_MM_MIN, RUN_OVERRIDE_PERCENT, RUN_LIMITER_PERCENT, RUN_SERIES_COUNT };
enum axis_series { AXIS_VELOCITY, AXIS_ACCELERATION, AXIS_JERK, AXIS_FOLLOWING, AXIS_SERIES_COUNT };

#define RECORDING_SERIES_MAX (RUN_SERIES_COUNT + AXIS_COUNT * AXIS_SERIES_COUNT)

/* An axis at the cycle before. */
struct axis_history {
    enum axis axis;
    double edge_ratio; /* mm or degrees for one mm or radian */
    double set;        /* mm or rad; its differences in mm and s or rad and s */
    double velocity;
    double acceleration;
};

struct recording {
    struct plan_limits limits;
    unsigned axis_count; /* axes the machine has */
    struct axis_history axis[AXIS_COUNT];
    bool has_rotary;
    uint64_t first_cycle;
    uint64_t cycles;                          /* recorded */
    uint64_t consecutive;                     /* cycles without a gap up to the last one */
    double linear_mm[AXIS_LINEAR_COUNT];      /* cmd of the cycle before */
    struct point sent[DRIVES_LATENCY_CYCLES]; /* set of the last cycles: a ring */
    struct thin thin;
    struct trail trail;
};

/* False: out of memory. recording_close frees it either way. */
bool recording_open(struct recording *rec, const struct plan_limits *limits);
void recording_close(struct recording *rec);
void recording_add(struct recording *rec, const struct cycle_record *record, bool rapid);

/* Where the series of the i-th axis the machine has stands among all. */
static inline unsigned recording_axis_series(unsigned i, enum axis_series series)
{
    return RUN_SERIES_COUNT + i * AXIS_SERIES_COUNT + series;
}

#endif
