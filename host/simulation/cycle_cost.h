/*
 * Duration of the firmware's control cycle, by the clock, of one in CYCLE_COST_EVERY cycles,
 * because reading the clock takes longer than some of what it would measure.
 */
#ifndef TAKT_HOST_CYCLE_COST_H
#define TAKT_HOST_CYCLE_COST_H

#include <stdint.h>

#define CYCLE_COST_EVERY   16
#define CYCLE_COST_STEP_NS 10
#define CYCLE_COST_STEPS   10000

struct cycle_cost {
    uint64_t count;
    uint64_t sum_ns, min_ns, max_ns;
    uint32_t
        steps[CYCLE_COST_STEPS + 1]; /* of CYCLE_COST_STEP_NS; the last holds everything beyond */
};

void cycle_cost_init(struct cycle_cost *cost);
void cycle_cost_add(struct cycle_cost *cost, uint64_t ns);

/* The duration that 99 % of the measured cycles did not exceed, ns. */
double cycle_cost_get_p99_ns(const struct cycle_cost *cost);

#endif
