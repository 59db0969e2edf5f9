/*
 * Shared by the sources of the embedded bus: bus.c, where nothing goes wrong, and bus_faults.c,
 * which does the same with faults. A test keeps them equal where no fault strikes.
 */
#ifndef TAKT_BUS_BUS_PRIVATE_H
#define TAKT_BUS_BUS_PRIVATE_H

#include "bus/bus.h"

#include <stddef.h>

/* The place of a frame of this rank among the waiting ones; the rest of it is the caller's. */
struct bus_waiting *bus_make_room(struct bus *bus, uint64_t order, unsigned port);

/*
 * Takes the waiting frame at this index onto the wire, which it holds from start_ns on for so long.
 */
void bus_put_on_wire(struct bus *bus, unsigned index, uint64_t start_ns, uint64_t length_ns);

/* The frame on the wire has ended: it counts and the observer sees it. */
void bus_count_frame(struct bus *bus);

/* Gives a frame, that on the wire, to a port. */
static inline void bus_deliver(const struct bus *bus, const struct bus_port *port,
                               const struct can_frame *frame)
{
    if (port->filter == NULL || can_passes(port->filter, frame->id))
        port->listener.on_frame(port->listener.context, frame, bus->now_ns);
}

/* The bus until time_ns with everything that can go wrong. */
void bus_run_faulty(struct bus *bus, uint64_t time_ns);

/* Something has gone wrong or may until then: bus_run_faulty is needed. */
static inline bool bus_is_faulty(const struct bus *bus, uint64_t time_ns)
{
    return bus->is_unwell || time_ns >= bus->fault_from_ns;
}

/* A frame is being sent: false if its port is off the bus; a delay moves *since_ns. */
bool bus_admit(struct bus *bus, unsigned port, uint16_t id, uint64_t *since_ns);

#endif
