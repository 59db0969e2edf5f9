#include "bus/bus.h"

#include <assert.h>
#include <string.h>

static_assert((BUS_RECEIVE_MAX & (BUS_RECEIVE_MAX - 1)) == 0, "receive indices are masked");

#define SECOND_NS 1000000000u

bool bus_init(struct bus *bus, uint32_t bitrate)
{
    if (bitrate < BUS_BITRATE_MIN || bitrate > BUS_BITRATE_MAX)
        return false;
    memset(bus, 0, sizeof *bus);
    bus->bit_ns = (SECOND_NS + bitrate / 2) / bitrate;
    frame_bits_init(&bus->tables);
    return true;
}

/*
 * Keeps bus->waiting in falling order. New frames mostly have high identifiers or few rivals, so
 * this is short.
 */
static void insert_waiting(struct bus *bus, unsigned port, const struct can_frame *frame)
{
    uint64_t order = (uint64_t)frame->id << 48 | bus->sent++;
    unsigned at = bus->waiting_count++;
    for (; at > 0 && bus->waiting[at - 1].order < order; at--)
        bus->waiting[at] = bus->waiting[at - 1];
    bus->waiting[at].order = order;
    bus->waiting[at].port = (uint16_t)port;
    bus->waiting[at].frame = *frame;
}

static bool port_send(void *context, const struct can_frame *frame)
{
    struct bus_port *port = context;
    struct bus *bus = port->bus;
    if (port->waiting == BUS_TRANSMIT_MAX || bus->waiting_count == BUS_WAITING_MAX) {
        bus->counts.refused++;
        return false;
    }
    port->waiting++;
    insert_waiting(bus, (unsigned)(port - bus->port), frame);
    return true;
}

static bool port_receive(void *context, struct can_frame *frame)
{
    struct bus_port *port = context;
    if (port->read == port->written)
        return false;
    *frame = port->received[port->read++ & (BUS_RECEIVE_MAX - 1)];
    return true;
}

struct can_port bus_attach(struct bus *bus, const struct bus_listener *listener)
{
    assert(bus->port_count < BUS_PORT_MAX);
    struct bus_port *port = &bus->port[bus->port_count++];
    port->bus = bus;
    if (listener)
        port->listener = *listener;
    return (struct can_port){.send = port_send, .receive = port_receive, .context = port};
}

void bus_observe(struct bus *bus, const struct bus_listener *listener)
{
    bus->observer = listener ? *listener : (struct bus_listener){0};
}

/* The bus is free: the waiting frame with the lowest identifier takes it. */
static void begin_frame(struct bus *bus)
{
    bus->wire = bus->waiting[--bus->waiting_count];
    bus->port[bus->wire.port].waiting--;
    uint64_t start_ns = bus->idle_ns > bus->now_ns ? bus->idle_ns : bus->now_ns;
    uint64_t frame_ns = frame_bits_count(&bus->tables, &bus->wire.frame) * bus->bit_ns;
    uint64_t space_ns = FRAME_BITS_INTERMISSION * bus->bit_ns;
    bus->frame_end_ns = start_ns + frame_ns;
    bus->idle_ns = bus->frame_end_ns + space_ns;
    bus->counts.busy_ns += frame_ns + space_ns;
    bus->on_wire = true;
}

static void collect(struct bus *bus, struct bus_port *port, const struct can_frame *frame)
{
    if (port->written - port->read == BUS_RECEIVE_MAX) {
        bus->counts.receive_lost++;
        return;
    }
    port->received[port->written++ & (BUS_RECEIVE_MAX - 1)] = *frame;
}

static void deliver(struct bus *bus, struct bus_port *port)
{
    if (port->listener.on_frame)
        port->listener.on_frame(port->listener.context, &bus->wire.frame, bus->now_ns);
    else
        collect(bus, port, &bus->wire.frame);
}

static void end_frame(struct bus *bus)
{
    bus->now_ns = bus->frame_end_ns;
    bus->on_wire = false;
    bus->counts.frames++;
    if (bus->observer.on_frame)
        bus->observer.on_frame(bus->observer.context, &bus->wire.frame, bus->now_ns);
    for (unsigned i = 0; i < bus->port_count; i++)
        if (i != bus->wire.port)
            deliver(bus, &bus->port[i]);
}

void bus_run_until(struct bus *bus, uint64_t time_ns)
{
    assert(time_ns >= bus->now_ns);
    while (bus->on_wire || bus->waiting_count > 0) {
        if (!bus->on_wire) {
            if (bus->idle_ns > time_ns)
                break;
            begin_frame(bus);
        }
        if (bus->frame_end_ns > time_ns)
            break;
        end_frame(bus);
    }
    bus->now_ns = time_ns;
}

uint64_t bus_now_ns(const struct bus *bus)
{
    return bus->now_ns;
}

bool bus_is_quiet(const struct bus *bus)
{
    return !bus->on_wire && bus->waiting_count == 0;
}

double bus_load_percent(const struct bus *bus)
{
    return bus->now_ns ? 100.0 * (double)bus->counts.busy_ns / (double)bus->now_ns : 0;
}

double bus_predict_load_percent(uint32_t bitrate, uint32_t cycle_us, const uint8_t length[],
                                unsigned count)
{
    unsigned bits = 0;
    for (unsigned i = 0; i < count; i++)
        bits += frame_bits_worst(length[i]);
    return 100.0 * bits / ((double)bitrate * cycle_us * 1e-6);
}
