#include "bus/bus.h"

#include "bus/bus_private.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

static_assert((BUS_RECEIVE_MAX & (BUS_RECEIVE_MAX - 1)) == 0, "receive indices are masked");

bool bus_init(struct bus *bus, uint32_t bitrate)
{
    return bus_init_rates(bus, &(struct frame_rates){bitrate, 0});
}

static bool are_good(const struct frame_rates *rates)
{
    return rates->nominal >= BUS_BITRATE_MIN && rates->nominal <= BUS_BITRATE_MAX &&
           (rates->data == 0 ||
            (rates->data >= rates->nominal && rates->data <= BUS_DATA_BITRATE_MAX));
}

bool bus_init_rates(struct bus *bus, const struct frame_rates *rates)
{
    if (!are_good(rates))
        return false;
    memset(bus, 0, offsetof(struct bus, waiting)); /* what follows is filled before it is read */
    bus->times = frame_bits_times(rates);
    bus->fault_from_ns = UINT64_MAX;
    frame_bits_init(&bus->tables);
    for (unsigned i = 0; i <= BUS_WAITING_MAX; i++)
        bus->waiting[i] = &bus->place[i];
    bus->wire = &bus->place[BUS_WAITING_MAX + 1];
    return true;
}

/*
 * Keeps bus->waiting in falling order. New frames mostly have high identifiers or few rivals, so
 * this is short.
 */
struct bus_waiting *bus_make_room(struct bus *bus, uint64_t order, unsigned port)
{
    struct bus_waiting **at = &bus->waiting[bus->waiting_count++];
    struct bus_waiting *free = *at;
    for (; at > bus->waiting && at[-1]->order < order; at--)
        at[0] = at[-1];
    *at = free;
    free->order = order;
    free->port = (uint16_t)port;
    bus->port[port].waiting++;
    return free;
}

/* There is not every length of CAN FD. */
static void fill_up(struct can_frame *frame)
{
    const uint8_t length = wire_frame_fd_length(frame->length);
    for (; frame->length < length; frame->length++)
        frame->data[frame->length] = 0;
}

static bool has_room(const struct bus_port *port)
{
    return port->waiting < BUS_TRANSMIT_MAX && port->bus->waiting_count < BUS_WAITING_MAX;
}

static bool port_send(void *context, const struct can_frame *frame)
{
    struct bus_port *port = context;
    struct bus *bus = port->bus;
    uint64_t since_ns = bus->now_ns;
    if (!has_room(port) ||
        (bus_is_faulty(bus, bus->now_ns) && !bus_admit(bus, port->index, frame->id, &since_ns))) {
        bus->counts.refused++;
        return false;
    }
    uint64_t order = (uint64_t)can_rank(frame->id) << 48 | bus->sent++;
    struct bus_waiting *waiting = bus_make_room(bus, order, port->index);
    waiting->since_ns = since_ns;
    waiting->is_repeat = false;
    can_copy(&waiting->frame, frame);
    if (bus_is_fd(bus) && !can_is_remote(frame))
        fill_up(&waiting->frame);
    return true;
}

static bool port_receive(void *context, struct can_frame *frame)
{
    struct bus_port *port = context;
    if (port->read == port->written)
        return false;
    can_copy(frame, &port->received[port->read++ & (BUS_RECEIVE_MAX - 1)]);
    return true;
}

/* What a port without a listener does with a frame. */
static void collect(void *context, const struct can_frame *frame, uint64_t time_ns)
{
    struct bus_port *port = context;
    (void)time_ns;
    if (port->read == port->written) /* the same memory again, as long as it is near */
        port->read = port->written = 0;
    if (port->written - port->read == BUS_RECEIVE_MAX)
        port->bus->counts.receive_lost++;
    else
        can_copy(&port->received[port->written++ & (BUS_RECEIVE_MAX - 1)], frame);
}

struct can_port bus_attach(struct bus *bus, const struct bus_listener *listener)
{
    return bus_attach_filtered(bus, listener, NULL);
}

struct can_port bus_attach_filtered(struct bus *bus, const struct bus_listener *listener,
                                    const uint32_t filter[CAN_FILTER_WORDS])
{
    assert(bus->port_count < BUS_PORT_MAX);
    struct bus_port *port = &bus->port[bus->port_count];
    memset(port, 0, offsetof(struct bus_port, received));
    port->bus = bus;
    port->index = bus->port_count++;
    port->filter = filter;
    port->listener =
        listener && listener->on_frame ? *listener : (struct bus_listener){collect, port};
    return (struct can_port){.send = port_send, .receive = port_receive, .context = port};
}

void bus_observe(struct bus *bus, const struct bus_listener *listener)
{
    bus->observer = listener ? *listener : (struct bus_listener){0};
}

void bus_put_on_wire(struct bus *bus, unsigned index, uint64_t start_ns, uint64_t length_ns)
{
    uint64_t space_ns = FRAME_BITS_INTERMISSION * bus->times.bit_ns;
    struct bus_waiting *free = bus->wire;
    bus->wire = bus->waiting[index];
    for (bus->waiting_count--; index < bus->waiting_count; index++)
        bus->waiting[index] = bus->waiting[index + 1];
    bus->waiting[index] = free;
    bus->port[bus->wire->port].waiting--;
    bus->frame_end_ns = start_ns + length_ns;
    bus->idle_ns = bus->frame_end_ns + space_ns;
    bus->counts.busy_ns += bus->idle_ns - start_ns;
    bus->on_wire = true;
}

/* The bus is free: the waiting frame with the lowest identifier takes it. */
static void begin_frame(struct bus *bus)
{
    unsigned winner = bus->waiting_count - 1;
    uint64_t start_ns = bus->idle_ns > bus->now_ns ? bus->idle_ns : bus->now_ns;
    const struct frame_length length =
        frame_bits_count_port(&bus->tables, &bus->waiting[winner]->frame, bus_is_fd(bus));
    bus_put_on_wire(bus, winner, start_ns, frame_bits_ns(&bus->times, &length));
}

void bus_count_frame(struct bus *bus)
{
    uint64_t response_ns = bus->now_ns - bus->wire->since_ns;
    uint32_t *most_ns = &bus->response_max_ns[bus->wire->frame.id % BUS_ID_COUNT];
    if (response_ns > *most_ns && !bus->has_ended_responses)
        *most_ns = response_ns < UINT32_MAX ? (uint32_t)response_ns : UINT32_MAX;
    bus->counts.frames++;
    if (bus->observer.on_frame)
        bus->observer.on_frame(bus->observer.context, &bus->wire->frame, bus->now_ns);
}

static void end_frame(struct bus *bus)
{
    bus->now_ns = bus->frame_end_ns;
    bus->on_wire = false;
    bus_count_frame(bus);
    const struct can_frame *frame = &bus->wire->frame;
    const struct bus_port *sender = &bus->port[bus->wire->port];
    const struct bus_port *end = &bus->port[bus->port_count];
    for (const struct bus_port *port = bus->port; port < end; port++)
        if (port != sender)
            bus_deliver(bus, port, frame);
}

static void run_clear(struct bus *bus, uint64_t time_ns)
{
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

void bus_run_until(struct bus *bus, uint64_t time_ns)
{
    assert(time_ns >= bus->now_ns);
    if (bus_is_faulty(bus, time_ns))
        bus_run_faulty(bus, time_ns);
    else
        run_clear(bus, time_ns);
}

uint64_t bus_now_ns(const struct bus *bus)
{
    return bus->now_ns;
}

bool bus_is_quiet(const struct bus *bus)
{
    return !bus->on_wire && bus->waiting_count == 0;
}

uint32_t bus_get_response_max_ns(const struct bus *bus, unsigned id)
{
    return bus->response_max_ns[id];
}

void bus_clear_responses(struct bus *bus)
{
    memset(bus->response_max_ns, 0, sizeof bus->response_max_ns);
    bus->has_ended_responses = false;
}

void bus_end_responses(struct bus *bus)
{
    bus->has_ended_responses = true;
}

double bus_load_percent(const struct bus *bus)
{
    return bus->now_ns ? 100.0 * (double)bus->counts.busy_ns / (double)bus->now_ns : 0;
}
