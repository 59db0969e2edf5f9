#include "takt/bus_plan.h"

#include "canopen/nmt.h"
#include "canopen/node.h"
#include "canopen/pdo.h"
#include "canopen/sdo.h"
#include "canopen/sync.h"

#include <string.h>

#define ERROR_LENGTH     6 /* error code and following error */
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

void bus_plan_set(struct bus_plan *plan, const struct machine *machine, const struct drives *drives)
{
    struct drives_pdo pdo[DRIVES_CYCLE_PDOS_MAX];
    unsigned count = drives_get_pdos(drives, pdo);

    memset(plan, 0, sizeof *plan);
    plan->bitrate = machine->can_bitrate;
    plan->cycle_ns = (uint64_t)machine->cycle_us * 1000;
    add_message(plan, "SYNC", SYNC_COB_ID, 0);
    for (unsigned i = 0; i < count; i++)
        add_message(plan, pdo[i].is_target ? "RPDO2" : "TPDO1", pdo[i].id, pdo[i].length);
    add_message(plan, "TPDO2", PDO_TPDO2_FUNCTION + NODE_MIN, ERROR_LENGTH);
    if (drives_have_probed(drives)) {
        add_message(plan, "SDO answer", SDO_RESPONSE_FUNCTION + NODE_MIN, CAN_DATA_MAX);
        add_message(plan, "SDO request", SDO_REQUEST_FUNCTION + NODE_MIN, CAN_DATA_MAX);
    }
    add_message(plan, "heartbeat", NMT_HEARTBEAT_FUNCTION + NODE_MIN, HEARTBEAT_LENGTH);
    (void)bus_response_predict(plan->message, plan->count, plan->bitrate, plan->worst_ns);
}

/* Of several nodes, but in the plan once. */
static bool is_of_any_node(const struct bus_message *message)
{
    const unsigned function = node_function(message->id);

    return function == PDO_TPDO2_FUNCTION || function == NMT_HEARTBEAT_FUNCTION ||
           function == SDO_RESPONSE_FUNCTION || function == SDO_REQUEST_FUNCTION;
}

static uint32_t find_observed_ns(const struct bus_plan *plan, const struct bus *bus, unsigned i)
{
    unsigned id = plan->message[i].id, nodes = 1;
    uint32_t most_ns = 0;

    if (is_of_any_node(&plan->message[i]))
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
