/*
 * The wall clock as the beat of control cycles, and what came of it.
 *
 * Cycle k is to begin at start + k cycle_ns: absolute times, so that a late cycle makes no other
 * late.
 */
#ifndef TAKT_HOST_PACE_H
#define TAKT_HOST_PACE_H

#include <stdbool.h>
#include <stdint.h>

#define PACE_STEP_NS 1000 /* of the histogram of lateness */
#define PACE_STEPS   20000

struct pace_figures {
    uint64_t cycles;
    uint64_t overruns; /* cycles whose work was not done when the next was to begin */
    uint64_t lateness_max_ns;
    double lateness_mean_ns, lateness_p99_ns; /* of the beginning of a cycle */
};

struct pace {
    uint64_t cycle_ns;
    uint64_t next_ns; /* when the next cycle is to begin, by link_clock_ns */
    uint64_t cycles, overruns;
    uint64_t sum_ns, max_ns;
    uint32_t steps[PACE_STEPS + 1]; /* the last holds everything beyond */
};

/* The first cycle begins now. */
void pace_start(struct pace *pace, uint64_t cycle_ns);

/* The work of a cycle is done: returns when the next is to begin. */
uint64_t pace_end_work(struct pace *pace);

/* Sleeps until then, through signals: a cycle is never cut short. */
void pace_sleep(const struct pace *pace);

/* A cycle begins: counts how late. */
void pace_begin_cycle(struct pace *pace);

void pace_get_figures(const struct pace *pace, struct pace_figures *figures);

/*
 * Asks the system for what a real-time process needs: first in the queue for the processor
 * (SCHED_FIFO), and all memory kept in place. Each says whether it was granted.
 */
struct pace_permission {
    bool has_priority;
    bool has_memory;
};

struct pace_permission pace_ask_permission(void);

#endif
