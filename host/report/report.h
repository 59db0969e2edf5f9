/*
 * The report of a run: one HTML file that opens offline, with the tool path in space, every axis
 * over time against its limits, and the summary.
 *
 *     struct report *r = report_open(&limits);
 *     ... every cycle: report_add(r, &record, rapid);
 *     error = report_write(r, file, summary_json);
 *     report_close(r);
 *
 * Memory (about 6 MB) and file (at most 10 MB) are bounded however long the run is; equal records
 * and an equal summary make equal bytes.
 */
#ifndef TAKT_REPORT_REPORT_H
#define TAKT_REPORT_REPORT_H

#include "motion/cycle_record.h"
#include "plan/limits.h"

#include <stdbool.h>
#include <stdio.h>

struct report;

/*
 * limits: of the machine, copied; which axes there are, what they may do, and the control cycle.
 * NULL: out of memory.
 */
struct report *report_open(const struct plan_limits *limits);
/* NULL is allowed. */
void report_close(struct report *r);

/*
 * The next cycle. rapid: it belongs to a rapid move. Velocity, acceleration and jerk are
 * differences of the setpoints sent over one cycle, so the first cycles have none; the following
 * error compares with the setpoint the drives answered, DRIVES_LATENCY_CYCLES before. Cycles from
 * the 2^32nd on are left out.
 */
void report_add(struct report *r, const struct cycle_record *record, bool rapid);

/*
 * The error of the tool's point over the working volume, as JSON: {"x": [...], "y": [...], "z":
 * [...], "before": [[ex, ey, ez], ...], "after": [...]}, positions in mm, errors in um, x changing
 * fastest, then y. It must outlive report_write.
 */
void report_set_map(struct report *r, const char *map_json);

/*
 * Who planned what share of the time at each limit, as JSON: {"board": {"time_s": ..., "velocity":
 * 0 ... 1, "acceleration": ..., "jerk": ...}, "ahead": {likewise}}. It must outlive report_write.
 */
void report_set_shares(struct report *r, const char *shares_json);

/*
 * Writes the page, to be called once, at the end. summary_json: the run's summary, zero-terminated,
 * as `takt run --json` writes it. 0 or an errno; the file is flushed and stays the caller's.
 */
int report_write(struct report *r, FILE *file, const char *summary_json);

/*
 * NULL when this executable can draw; else why reports have tables alone and what to do about it,
 * one sentence.
 */
const char *report_get_plots_missing(void);

#endif
