/*
 * Planning without a machine: the program through the same path, ceiling and motion that the
 * controller uses, in virtual time, without drives.
 */
#ifndef TAKT_HOST_PLANNER_H
#define TAKT_HOST_PLANNER_H

#include "cli/status.h"
#include "plan/block.h"
#include "session/session.h"

#include <stdbool.h>
#include <stdint.h>

/* A block as it has been passed. */
struct planned_block {
    const struct block *block;
    double feed_start_mm_s;
    double feed_cruise_mm_s; /* the highest in it */
    double feed_end_mm_s;
    double
        path_feed_mm_s; /* likewise the highest, by the path: a smoothed one counts nominal time */
    /* F of the program, of a motion of linear axes; 0: a rapid, a feed per revolution, none */
    double program_mm_s;
    double time_s;
    enum governor governor;
};

struct planner_totals {
    uint32_t stops; /* ends of motions at rest */
    uint64_t cycles;
};

struct planner_listener {
    void *context;
    /* Hears of every block, in order. */
    void (*take)(void *context, const struct planned_block *planned);
    /*
     * NULL, or asked in every cycle: is more of the program wanted? planned has the feeds so far of
     * the block being passed.
     */
    bool (*wants_more)(void *context, const struct planned_block *planned);
};

/*
 * Plans the program. STATUS_DONE, STATUS_FAILED or STATUS_ENVIRONMENT after a message,
 * STATUS_INTERRUPTED. The program has been checked.
 */
enum command_status planner_walk(const struct session *s, const struct planner_listener *listener,
                                 struct planner_totals *totals);

#endif
