/*
 * The frames of a control cycle, and how long each may take at most: what can be told of a bus
 * before anything runs.
 */
#ifndef TAKT_HOST_BUS_PLAN_H
#define TAKT_HOST_BUS_PLAN_H

#include "bus/bus.h"
#include "bus/bus_response.h"
#include "drive/drives.h"
#include "machine/machine.h"

#include <stdbool.h>

/*
 * SYNC, the PDOs of drives and I/O nodes in every cycle; and one TPDO2 and one heartbeat, which
 * nodes send in turns, or a guarding frame and its answer. Where touch probes have been used there
 * is a request and its answer, too; what has to wait for these may be without a bound.
 */
#define BUS_PLAN_MAX (7 + DRIVES_CYCLE_PDOS_MAX)

/* Messages that nodes send in turns: in the plan they stand for those of all nodes. */
enum bus_plan_group { BUS_PLAN_ALONE, BUS_PLAN_ERRORS, BUS_PLAN_SDO, BUS_PLAN_STATES };

struct bus_plan {
    struct frame_rates rates;
    uint64_t cycle_ns;
    unsigned count;
    struct bus_message message[BUS_PLAN_MAX];
    const char *name[BUS_PLAN_MAX];
    enum bus_plan_group group[BUS_PLAN_MAX];
    unsigned error_count;
    uint8_t error_length;            /* of the longest of these: */
    uint16_t error_id[AXIS_COUNT];   /* TPDOs with the drives' error codes */
    uint64_t worst_ns[BUS_PLAN_MAX]; /* from being given to the last bit; UINT64_MAX: no bound */
};

void bus_plan_set(struct bus_plan *plan, const struct machine *machine, const struct drives *drives,
                  unsigned bus);

/* What messages have taken at most on this bus since bus_clear_responses; 0: none was sent. */
void bus_plan_get_observed(const struct bus_plan *plan, const struct bus *bus,
                           uint64_t observed_ns[BUS_PLAN_MAX]);

#endif
