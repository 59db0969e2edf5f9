/*
 * A trace played back for the page in the browser: the registers and setpoints of a machine that is
 * not there. Start, hold, resume, reset, START_LINE and the feed override count for the playing;
 * all other orders are refused.
 *
 *     viewing_order      what pages want
 *     viewing_cycle      one row of the trace later, or as many as the speed says
 *     viewing_look       the registers
 */
#ifndef TAKT_HOST_VIEWING_H
#define TAKT_HOST_VIEWING_H

#include "config/machine_setup.h"
#include "page/page_link.h"
#include "panel/snapshot.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct view_row {
    struct point set, actual; /* mm, rad */
    float feed_mm_min, override_percent, limiter;
    uint32_t line, block;
};

struct viewing {
    const struct machine *machine;
    struct view_row *row; /* owned */
    size_t count, room;
    double cycle_s;
    double speed; /* rows a cycle, at 100 % */
    double at;    /* row */
    enum panel_state state;
    uint32_t override_counts, start_line, runs, cycles, watchdog_ms;
};

/* Reads a trace. False after a message; viewing_close is due in either case. */
bool viewing_open(struct viewing *v, const char *path, const struct machine *machine, double speed);
void viewing_close(struct viewing *v);

enum panel_verdict viewing_order(struct viewing *v, const struct panel_order *order);
void viewing_cycle(struct viewing *v, struct page_link *link);
void viewing_look(const struct viewing *v, struct panel_snapshot *snapshot);

#endif
