#include "takt/bus_plan.h"

#include "canopen/nmt.h"
#include "canopen/node.h"
#include "canopen/pdo.h"
#include "canopen/sync.h"
#include "canopen/target_pdo.h"

#include <string.h>

#define STATUS_LENGTH    6 /* statusword and position; error code and following error */
#define HEARTBEAT_LENGTH 1

/*
 * Each is given once between two SYNCs, answers after the SYNC they answer. So as long as all end
 * before the next SYNC, none meets two of another, and the time an answer waits for its SYNC is no
 * jitter.
 */
static void add_message(struct bus_plan *plan, const char *name, unsigned id, unsigned length)
{
    plan->name[plan->count] = name;
    plan->message[plan->count++] = (struct bus_message){
        .id = (uint16_t)id, .length = (uint8_t)length, .period_ns = plan->cycle_ns};
}

/* The frame of a pair is added with its second drive, or with the last of an odd number. */
static void add_drive(struct bus_plan *plan, const uint8_t nodes[], unsigned count, unsigned i)
{
    struct pdo target, next = {0};

    add_message(plan, "TPDO1", PDO_TPDO1_FUNCTION + nodes[i], STATUS_LENGTH);
    target_pdo_set(&target, nodes, count, i);
    if (i + 1 < count)
        target_pdo_set(&next, nodes, count, i + 1);
    if (next.cob_id != target.cob_id)
        add_message(plan, "RPDO2", target.cob_id, target.mapping.length);
}

void bus_plan_set(struct bus_plan *plan, const struct machine *machine)
{
    uint8_t nodes[AXIS_COUNT];
    unsigned count = 0;

    memset(plan, 0, sizeof *plan);
    plan->bitrate = machine->can_bitrate;
    plan->cycle_ns = (uint64_t)machine->cycle_us * 1000;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (machine_axis_is_on_can(&machine->axis[i]))
            nodes[count++] = machine->axis[i].drive_node;
    }
    add_message(plan, "SYNC", SYNC_COB_ID, 0);
    for (unsigned i = 0; i < count; i++)
        add_drive(plan, nodes, count, i);
    add_message(plan, "TPDO2", PDO_TPDO2_FUNCTION + NODE_MIN, STATUS_LENGTH);
    add_message(plan, "heartbeat", NMT_HEARTBEAT_FUNCTION + NODE_MIN, HEARTBEAT_LENGTH);
    (void)bus_response_predict(plan->message, plan->count, plan->bitrate, plan->worst_ns);
}

/* For TPDO2 and heartbeats, whichever node they are of. */
static uint32_t find_observed_ns(const struct bus_plan *plan, const struct bus *bus, unsigned i)
{
    unsigned id = plan->message[i].id, nodes = 1;
    uint32_t most_ns = 0;

    if (node_function((uint16_t)id) == PDO_TPDO2_FUNCTION ||
        node_function((uint16_t)id) == NMT_HEARTBEAT_FUNCTION)
        nodes = NODE_MAX;
    for (unsigned k = 0; k < nodes; k++) {
        uint32_t response_ns = bus_get_response_max_ns(bus, id + k);

        most_ns = response_ns > most_ns ? response_ns : most_ns;
    }
    return most_ns;
}

void bus_plan_get_observed(const struct bus_plan *plan, const struct bus *bus,
                           uint64_t observed_ns[BUS_PLAN_MAX])
{
    for (unsigned i = 0; i < plan->count; i++)
        observed_ns[i] = find_observed_ns(plan, bus, i);
}
