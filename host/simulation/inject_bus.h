/*
 * The bus faults of a script, on the embedded bus.
 */
#ifndef TAKT_HOST_INJECT_BUS_H
#define TAKT_HOST_INJECT_BUS_H

#include "bus/bus.h"
#include "inject/inject.h"

#include <stdbool.h>
#include <stdint.h>

/*
 * bus: of this index in the machine. Adds its faults whose time counts from this anchor, which is
 * at anchor_ns of the bus. The controller is the bus's first port, then come the drives in the
 * order of nodes. False: the bus holds no more faults, after a message.
 */
bool inject_bus_add(struct bus *bus, unsigned index, const struct inject *script,
                    enum inject_anchor anchor, uint64_t anchor_ns, const uint8_t nodes[],
                    unsigned count);

#endif
