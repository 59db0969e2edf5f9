#include "simulation/cycle_cost.h"

#include <string.h>

void cycle_cost_init(struct cycle_cost *cost)
{
    memset(cost, 0, sizeof *cost);
    cost->min_ns = UINT64_MAX;
}

void cycle_cost_add(struct cycle_cost *cost, uint64_t ns)
{
    uint64_t step = ns / CYCLE_COST_STEP_NS;

    cost->count++;
    cost->sum_ns += ns;
    if (ns < cost->min_ns)
        cost->min_ns = ns;
    if (ns > cost->max_ns)
        cost->max_ns = ns;
    cost->steps[step < CYCLE_COST_STEPS ? step : CYCLE_COST_STEPS]++;
}

double cycle_cost_get_p99_ns(const struct cycle_cost *cost)
{
    uint64_t wanted = cost->count - cost->count / 100;
    uint64_t seen = 0;

    for (unsigned i = 0; i < CYCLE_COST_STEPS; i++) {
        seen += cost->steps[i];
        if (seen >= wanted)
            return (double)(i + 1) * CYCLE_COST_STEP_NS;
    }
    return (double)cost->max_ns;
}
