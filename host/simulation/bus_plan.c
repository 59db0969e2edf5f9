#include "simulation/bus_plan.h"

#include "canopen/nmt.h"
#include "canopen/node.h"
#include "canopen/pdo.h"
#include "canopen/sdo.h"
#include "canopen/sync.h"
#include "config/machine_setup.h"

#include <string.h>

#define HEARTBEAT_LENGTH 1

/*
 * Each is given once between two SYNCs, answers after the SYNC they answer. So as long as all end
 * before the next SYNC, none meets two of another, and the time an answer waits for its SYNC is no
 * jitter.
 */
static void add_message(struct bus_plan *plan, const char *name, unsigned id, unsigned length,
                        enum bus_plan_group group)
{
    plan->name[plan->count] = name;
    plan->group[plan->count] = group;
    plan->message[plan->count++] = (struct bus_message){
        .id = (uint16_t)id, .length = (uint8_t)length, .period_ns = plan->cycle_ns};
}

static void add_pdo(struct bus_plan *plan, const struct drives_pdo *pdo)
{
    static const char *const names[] = {[DRIVES_PDO_REPORT] = "TPDO1",
                                        [DRIVES_PDO_TARGET] = "RPDO2",
                                        [DRIVES_PDO_INPUTS] = "inputs",
                                        [DRIVES_PDO_OUTPUTS] = "outputs"};

    if (pdo->kind == DRIVES_PDO_ERROR) {
        plan->error_id[plan->error_count++] = pdo->id;
        plan->error_length = pdo->length > plan->error_length ? pdo->length : plan->error_length;
    } else {
        add_message(plan, names[pdo->kind], pdo->id, pdo->length, BUS_PLAN_ALONE);
    }
}

static bool has_between(const struct bus_plan *plan, unsigned lowest, unsigned highest)
{
    bool has = false;

    for (unsigned i = 0; i < plan->count; i++)
        has = has || (plan->message[i].id > lowest && plan->message[i].id < highest);
    return has;
}

/*
 * One of them comes in a cycle. As it may be any, it stands where it delays most, and, if others
 * are between, also where it is delayed most.
 */
static void add_errors(struct bus_plan *plan)
{
    unsigned lowest = NODE_FUNCTION_MASK + NODE_MAX, highest = 0;

    for (unsigned i = 0; i < plan->error_count; i++) {
        lowest = plan->error_id[i] < lowest ? plan->error_id[i] : lowest;
        highest = plan->error_id[i] > highest ? plan->error_id[i] : highest;
    }
    if (plan->error_count > 0)
        add_message(plan, "TPDO2", lowest, plan->error_length, BUS_PLAN_ERRORS);
    if (has_between(plan, lowest, highest))
        add_message(plan, "TPDO2", highest, plan->error_length, BUS_PLAN_ERRORS);
}

/* As often as nodes send them at most, a cycle apart at least. */
static uint64_t beat_ns(const struct machine *machine)
{
    const uint64_t cycle_ns = UINT64_C(1000) * machine->cycle_us;
    const uint64_t cycles = UINT64_C(1000000) * machine->heartbeat_ms / cycle_ns;

    return cycles > 1 ? cycles * cycle_ns : cycle_ns;
}

static void add_states(struct bus_plan *plan, const struct machine *machine,
                       const struct drives *drives, unsigned bus)
{
    const unsigned id = NMT_HEARTBEAT_FUNCTION + NODE_MIN;

    add_message(plan, "heartbeat", NMT_HEARTBEAT_FUNCTION + NODE_MAX, HEARTBEAT_LENGTH,
                BUS_PLAN_STATES);
    plan->message[plan->count - 1].period_ns = beat_ns(machine);
    if (takt_drives_are_guarding(drives, bus)) {
        add_message(plan, "guarding", id + 1, 0, BUS_PLAN_STATES);
        plan->message[plan->count - 1].is_remote = true;
        add_message(plan, "its answer", id + 2, HEARTBEAT_LENGTH, BUS_PLAN_STATES);
    }
}

/*
 * Each node has a clock of its own, so the heartbeats of all may meet: the plan's is the last of
 * them.
 */
static void predict(struct bus_plan *plan, const struct machine *machine, unsigned bus)
{
    struct bus_message all[BUS_PLAN_MAX + MACHINE_NODES_MAX + IO_NODES_MAX];
    uint64_t worst_ns[sizeof all / sizeof all[0]];
    uint8_t node[MACHINE_NODES_MAX];
    unsigned others = takt_machine_bus_nodes(machine, bus, node);

    for (unsigned i = 0; i < takt_machine_io_count(machine); i++)
        others += machine->io[i].bus == bus;
    memcpy(all, plan->message, sizeof plan->message);
    for (unsigned i = 0; i < others && machine->heartbeat_ms > 0; i++)
        all[plan->count + i] =
            (struct bus_message){.id = (uint16_t)(NMT_HEARTBEAT_FUNCTION + NODE_MIN + 3 + i),
                                 .length = HEARTBEAT_LENGTH,
                                 .period_ns = beat_ns(machine)};
    (void)bus_response_predict(all, plan->count + (machine->heartbeat_ms > 0 ? others : 0),
                               &plan->rates, worst_ns);
    memcpy(plan->worst_ns, worst_ns, plan->count * sizeof worst_ns[0]);
}

/* Any of a group may be the last of it. */
static void level_groups(struct bus_plan *plan)
{
    for (unsigned i = 0; i < plan->count; i++)
        for (unsigned k = 0; k < plan->count; k++)
            if (plan->group[i] != BUS_PLAN_ALONE && plan->group[k] == plan->group[i] &&
                plan->worst_ns[k] > plan->worst_ns[i])
                plan->worst_ns[i] = plan->worst_ns[k];
}

void bus_plan_set(struct bus_plan *plan, const struct machine *machine, const struct drives *drives,
                  unsigned bus)
{
    struct drives_pdo pdo[DRIVES_CYCLE_PDOS_MAX];
    unsigned count = takt_drives_get_pdos(drives, bus, pdo);

    memset(plan, 0, sizeof *plan);
    plan->rates = machine_setup_get_rates(machine);
    plan->cycle_ns = (uint64_t)machine->cycle_us * 1000;
    add_message(plan, "SYNC", SYNC_COB_ID, 0, BUS_PLAN_ALONE);
    for (unsigned i = 0; i < count; i++)
        add_pdo(plan, &pdo[i]);
    add_errors(plan);
    if (takt_drives_have_probed(drives)) {
        add_message(plan, "SDO answer", SDO_RESPONSE_FUNCTION + NODE_MIN, CAN_CLASSIC_MAX,
                    BUS_PLAN_SDO);
        add_message(plan, "SDO request", SDO_REQUEST_FUNCTION + NODE_MIN, CAN_CLASSIC_MAX,
                    BUS_PLAN_SDO);
    }
    add_states(plan, machine, drives, bus);
    predict(plan, machine, bus);
    level_groups(plan);
}

static uint32_t longest_of_function(const struct bus *bus, unsigned function)
{
    uint32_t most_ns = 0;

    for (unsigned node = NODE_MIN; node <= NODE_MAX; node++) {
        uint32_t response_ns = bus_get_response_max_ns(bus, function + node);

        most_ns = response_ns > most_ns ? response_ns : most_ns;
    }
    return most_ns;
}

static uint32_t longest_of_errors(const struct bus_plan *plan, const struct bus *bus)
{
    uint32_t most_ns = 0;

    for (unsigned i = 0; i < plan->error_count; i++) {
        uint32_t response_ns = bus_get_response_max_ns(bus, plan->error_id[i]);

        most_ns = response_ns > most_ns ? response_ns : most_ns;
    }
    return most_ns;
}

static uint32_t find_observed_ns(const struct bus_plan *plan, const struct bus *bus, unsigned i)
{
    const unsigned id = plan->message[i].id;

    switch (plan->group[i]) {
    case BUS_PLAN_ERRORS:
        return longest_of_errors(plan, bus);
    case BUS_PLAN_SDO:
    case BUS_PLAN_STATES:
        return longest_of_function(bus, node_function((uint16_t)id));
    case BUS_PLAN_ALONE:
        break;
    }
    return bus_get_response_max_ns(bus, id);
}

void bus_plan_get_observed(const struct bus_plan *plan, const struct bus *bus,
                           uint64_t observed_ns[BUS_PLAN_MAX])
{
    for (unsigned i = 0; i < plan->count; i++)
        observed_ns[i] = find_observed_ns(plan, bus, i);
}
