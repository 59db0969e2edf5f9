/*
 * The virtual machine in virtual time: firmware, embedded CAN bus and virtual drives, cycle by cycle.
 *
 *     controller_background, controller_cycle -> frames -> bus -> drives -> motors -> frames -> controller
 */
#ifndef TAKT_HOST_SIMULATION_H
#define TAKT_HOST_SIMULATION_H

#include "bus/bus.h"
#include "controller/controller.h"
#include "drives/virtual_drives.h"
#include "hal/inputs.h"
#include "takt/session.h"

#include <stdbool.h>
#include <stdint.h>

/* Duration of the firmware's control cycle, by the clock, in steps of CYCLE_COST_STEP_NS; of one in
 * CYCLE_COST_EVERY cycles, because reading the clock takes longer than some of what it would measure. */
#define CYCLE_COST_EVERY   16
#define CYCLE_COST_STEP_NS 10
#define CYCLE_COST_STEPS   10000

struct cycle_cost {
    uint64_t count;
    uint64_t sum_ns, min_ns, max_ns;
    uint32_t steps[CYCLE_COST_STEPS + 1]; /* the last holds everything beyond */
};

struct simulation {
    struct bus bus;
    struct virtual_drives drives;
    struct controller controller;
    struct parameters parameters; /* what the program sets */
    struct source_text text;
    struct inputs inputs; /* of the next cycle */
    uint64_t cycles;      /* since power-on, drive start included */
    uint32_t cycle_ns;
    struct cycle_cost cost;
};

/* The drives boot and stand at 0; the program waits for its first cycle. NULL: out of memory. */
struct simulation *simulation_open(const struct session *session);
void simulation_close(struct simulation *s);

/* One control cycle of everything. */
void simulation_step(struct simulation *s);

/* The duration that 99 % of the measured cycles did not exceed, ns. */
double cycle_cost_get_p99_ns(const struct cycle_cost *cost);

#endif
