#include "simulation/inject_bus.h"

#include "cli/message.h"

#define ID_MASK 0x7FF

static enum bus_fault_kind kind_of(enum inject_kind kind)
{
    static const enum bus_fault_kind kinds[] = {
        [INJECT_DROP] = BUS_FAULT_DROP,
        [INJECT_CORRUPT] = BUS_FAULT_CORRUPT,
        [INJECT_DUPLICATE] = BUS_FAULT_DUPLICATE,
        [INJECT_DELAY] = BUS_FAULT_DELAY,
        [INJECT_ERROR_PASSIVE] = BUS_FAULT_ERROR_PASSIVE,
        [INJECT_BUS_OFF] = BUS_FAULT_BUS_OFF,
        [INJECT_CUT] = BUS_FAULT_CUT,
    };

    return kinds[kind];
}

static uint32_t port_bit(uint8_t node, const uint8_t nodes[], unsigned count)
{
    if (node == INJECT_CONTROLLER)
        return 1;
    for (unsigned i = 0; i < count; i++) {
        if (nodes[i] == node)
            return 2u << i;
    }
    return 0;
}

static struct bus_fault translate(const struct inject_fault *fault, uint64_t anchor_ns,
                                  const uint8_t nodes[], unsigned count)
{
    struct bus_fault translated = {
        .kind = kind_of(fault->kind),
        .ports = port_bit(fault->node, nodes, count),
        .from_ns = anchor_ns + fault->after_ns,
        .skip = fault->skip,
        .count = fault->frames == INJECT_ALL ? BUS_FAULT_ALWAYS : fault->frames,
        .probability = fault->ratio < 1 ? fault->ratio : 0,
        .seed = fault->seed,
        .delay_ns = fault->by_ns,
    };

    if (fault->id != INJECT_ANY_ID) {
        translated.id = fault->id;
        translated.id_mask = ID_MASK;
    }
    if (fault->for_ns != 0 && fault->for_ns != INJECT_ALWAYS)
        translated.until_ns = translated.from_ns + fault->for_ns;
    return translated;
}

bool inject_bus_add(struct bus *bus, unsigned index, const struct inject *script,
                    enum inject_anchor anchor, uint64_t anchor_ns, const uint8_t nodes[],
                    unsigned count)
{
    for (unsigned i = 0; i < script->count; i++) {
        const struct inject_fault *fault = &script->fault[i];
        struct bus_fault translated;

        if (!inject_is_of_bus(fault->kind) || fault->anchor != anchor || fault->bus != index)
            continue;
        translated = translate(fault, anchor_ns, nodes, count);
        if (!bus_add_fault(bus, &translated)) {
            message_command_error("--inject: line %u: more faults than the bus can hold",
                                  (unsigned)fault->line);
            return false;
        }
    }
    return true;
}
