/*
 * The embedded bus with everything that can go wrong: which frame begins next when ports are cut
 * off, late or suspended, and what becomes of a frame that is hit.
 *
 *     begin_next ---> on the wire ---> end_good: counted, delivered
 *         ^                  |
 *         |                  +-------> end_bad: error frame; back among the waiting ones
 *         +--------------------------------'
 *
 * Fault confinement (ISO 11898-1): a sender's error counter rises by 8 with each error and falls by
 * 1 with each success, a receiver's by 1; above 127 a node is error passive, above 255 off the bus,
 * until it has seen 128 times 11 recessive bits.
 */
#include "bus/bus_private.h"
#include "bus/frame_levels.h"

#include <string.h>

#define TRANSMIT_ERROR_STEP 8
#define PASSIVE_ERRORS      128 /* a counter from here on: error passive */
#define RECEIVE_ERRORS_MAX  (PASSIVE_ERRORS + 7)
#define OFF_ERRORS          256            /* the transmit counter from here on: bus-off */
#define RECOVERY_BITS       UINT64_C(1408) /* 128 times 11 */
#define SUSPEND_BITS        8u
#define ERROR_FLAG_BITS     6u
#define ERROR_DELIMITER     8u
/* Start of frame, identifier, RTR: an error there would be lost arbitration. */
#define ARBITRATION_BITS 13u

static bool is_of_ports(const struct bus_fault *fault)
{
    return fault->kind == BUS_FAULT_CUT || fault->kind == BUS_FAULT_BUS_OFF ||
           fault->kind == BUS_FAULT_ERROR_PASSIVE;
}

static uint64_t end_of(const struct bus_fault *fault)
{
    return fault->until_ns ? fault->until_ns : UINT64_MAX;
}

/* No fault does anything before this time. */
static void find_first_fault(struct bus *bus)
{
    bus->fault_from_ns = UINT64_MAX;
    for (unsigned i = 0; i < bus->fault_count; i++)
        if (!bus->fault[i].done && bus->fault[i].fault.from_ns < bus->fault_from_ns)
            bus->fault_from_ns = bus->fault[i].fault.from_ns;
}

bool bus_add_fault(struct bus *bus, const struct bus_fault *fault)
{
    if (bus->fault_count == BUS_FAULTS_MAX)
        return false;
    bus->fault[bus->fault_count++] =
        (struct bus_fault_state){.fault = *fault, .random = fault->seed};
    find_first_fault(bus);
    return true;
}

void bus_end_faults(struct bus *bus)
{
    for (unsigned i = 0; i < bus->fault_count; i++) {
        struct bus_fault *fault = &bus->fault[i].fault;

        if (end_of(fault) > bus->now_ns)
            fault->until_ns = bus->now_ns > 0 ? bus->now_ns : 1;
    }
}

enum bus_confinement bus_get_confinement(const struct bus *bus, unsigned port)
{
    const struct bus_port *p = &bus->port[port];
    if (p->off_until_ns != 0)
        return BUS_OFF;
    for (unsigned i = 0; i < bus->fault_count; i++) {
        const struct bus_fault *fault = &bus->fault[i].fault;
        if (fault->kind == BUS_FAULT_BUS_OFF && (fault->ports >> port & 1) &&
            bus->now_ns >= fault->from_ns && bus->now_ns < end_of(fault))
            return BUS_OFF;
    }
    return p->transmit_errors >= PASSIVE_ERRORS || p->receive_errors >= PASSIVE_ERRORS ? BUS_PASSIVE
                                                                                       : BUS_ACTIVE;
}

/* Knuth's linear congruential generator, 0 <= result < 1 from its upper bits. */
static double draw(uint64_t *random)
{
    *random = *random * 6364136223846793005u + 1442695040888963407u;
    return (double)(*random >> 11) / 9007199254740992.0;
}

static bool matches(const struct bus_fault *fault, const struct bus_waiting *frame, uint64_t at_ns)
{
    return (frame->frame.id & fault->id_mask) == (fault->id & fault->id_mask) &&
           (fault->ports == 0 || (fault->ports >> frame->port & 1)) && at_ns >= fault->from_ns &&
           at_ns < end_of(fault);
}

/* The fault of frames strikes this one now. */
static bool strikes(struct bus_fault_state *state, const struct bus_waiting *frame, uint64_t at_ns)
{
    const struct bus_fault *fault = &state->fault;
    if (state->done || !matches(fault, frame, at_ns))
        return false;
    if (state->passed < fault->skip) {
        state->passed++;
        return false;
    }
    if (fault->probability > 0 && draw(&state->random) >= fault->probability)
        return false;
    state->struck++;
    state->done = fault->count != BUS_FAULT_ALWAYS && state->struck >= fault->count;
    return true;
}

/* When a port can take part again, from at_ns on; UINT64_MAX: never. */
static uint64_t connected_from_ns(const struct bus *bus, unsigned port, uint64_t at_ns)
{
    uint64_t from_ns = at_ns;
    if (bus->port[port].off_until_ns > from_ns)
        from_ns = bus->port[port].off_until_ns;
    for (unsigned i = 0; i < bus->fault_count; i++) {
        const struct bus_fault *fault = &bus->fault[i].fault;
        if ((fault->kind != BUS_FAULT_CUT && fault->kind != BUS_FAULT_BUS_OFF) ||
            !(fault->ports >> port & 1) || from_ns < fault->from_ns || from_ns >= end_of(fault))
            continue;
        if (fault->until_ns == 0)
            return UINT64_MAX;
        return connected_from_ns(bus, port, fault->until_ns); /* another may have begun by then */
    }
    return from_ns;
}

static bool is_connected(const struct bus *bus, unsigned port, uint64_t at_ns)
{
    return connected_from_ns(bus, port, at_ns) == at_ns;
}

bool bus_admit(struct bus *bus, unsigned port, uint16_t id, uint64_t *since_ns)
{
    const struct bus_waiting frame = {.port = (uint16_t)port, .frame = {.id = id}};
    if (bus_get_confinement(bus, port) == BUS_OFF)
        return false;
    for (unsigned i = 0; i < bus->fault_count; i++) {
        struct bus_fault_state *state = &bus->fault[i];
        if (state->fault.kind != BUS_FAULT_DELAY || !strikes(state, &frame, bus->now_ns))
            continue;
        *since_ns += state->fault.delay_ns;
        bus->counts.delayed++;
        bus->is_unwell = true;
    }
    return true;
}

/* A controller that goes off the bus forgets what it was to send. */
static void lose_waiting(struct bus *bus, unsigned port)
{
    unsigned kept = 0;
    for (unsigned i = 0; i < bus->waiting_count; i++) {
        struct bus_waiting *waiting = bus->waiting[i];
        if (waiting->port == port) {
            bus->counts.off_lost++;
            continue;
        }
        bus->waiting[i] = bus->waiting[kept];
        bus->waiting[kept++] = waiting;
    }
    bus->waiting_count = kept;
    bus->port[port].waiting = 0;
}

static void strike_port(struct bus *bus, const struct bus_fault *fault, unsigned port)
{
    struct bus_port *p = &bus->port[port];
    if (fault->kind == BUS_FAULT_BUS_OFF)
        lose_waiting(bus, port);
    if (fault->kind == BUS_FAULT_ERROR_PASSIVE && p->transmit_errors < PASSIVE_ERRORS)
        p->transmit_errors = PASSIVE_ERRORS;
}

/*
 * Faults of ports that have begun by now; whoever has been off for long enough comes back with a
 * clean record.
 */
static void strike_ports(struct bus *bus, uint64_t at_ns)
{
    for (unsigned i = 0; i < bus->fault_count; i++) {
        struct bus_fault_state *state = &bus->fault[i];
        if (!is_of_ports(&state->fault) || state->struck > 0 || at_ns < state->fault.from_ns)
            continue;
        state->struck = 1;
        for (unsigned port = 0; port < bus->port_count; port++)
            if (state->fault.ports >> port & 1)
                strike_port(bus, &state->fault, port);
    }
    for (unsigned port = 0; port < bus->port_count; port++) {
        struct bus_port *p = &bus->port[port];
        if (p->off_until_ns != 0 && p->off_until_ns <= at_ns)
            p->off_until_ns = p->transmit_errors = p->receive_errors = 0;
    }
}

/* When a waiting frame may begin at the earliest. */
static uint64_t ready_ns(const struct bus *bus, const struct bus_waiting *waiting, uint64_t at_ns)
{
    uint64_t suspended_ns = bus->port[waiting->port].suspend_until_ns;
    if (waiting->since_ns > at_ns)
        at_ns = waiting->since_ns;
    return connected_from_ns(bus, waiting->port, suspended_ns > at_ns ? suspended_ns : at_ns);
}

static void draw_verdict(struct bus *bus, const struct bus_waiting *frame, uint64_t at_ns,
                         unsigned bits)
{
    bus->verdict = (struct bus_verdict){0};
    for (unsigned i = 0; i < bus->fault_count; i++) {
        struct bus_fault_state *state = &bus->fault[i];
        enum bus_fault_kind kind = state->fault.kind;
        if (kind != BUS_FAULT_DROP && kind != BUS_FAULT_CORRUPT && kind != BUS_FAULT_DUPLICATE)
            continue;
        if ((kind == BUS_FAULT_DUPLICATE && frame->is_repeat) || !strikes(state, frame, at_ns))
            continue;
        if (kind == BUS_FAULT_DROP)
            bus->verdict.is_dropped = true;
        else if (kind == BUS_FAULT_DUPLICATE)
            bus->verdict.is_duplicated = true;
        else
            bus->verdict.corrupt_bit =
                ARBITRATION_BITS + (unsigned)(draw(&state->random) * (bits - ARBITRATION_BITS - 1));
    }
}

/* Time of the first bits of a frame. */
static uint64_t first_bits_ns(const struct bus *bus, const struct frame_levels *levels,
                              unsigned count)
{
    unsigned data = 0;
    if (count > levels->data_begin)
        data = (count < levels->data_end ? count : levels->data_end) - levels->data_begin;
    return frame_bits_ns(&bus->times, &(struct frame_length){count - data, data});
}

/*
 * Time from the start of a frame to the end of the error frame that follows when bit k of it is
 * flipped.
 *
 *     k + 1 + wait + 6 + 8 bits     wait: 0 ... 6
 *
 * The sender sees the wrong bit and begins its flag of 6 dominant bits at once, at the nominal
 * rate. Receivers see 6 equal bits in a row where stuffing allows 5, and then begin theirs: with r
 * dominant bits at the end of the frame so far, 6 - r later, by the rate at which they read. A bit
 * that is fixed (end of frame), or that makes 6 equal bits itself, is seen by all at once.
 */
static uint64_t until_error_ends_ns(const struct bus *bus, struct frame_levels *levels, unsigned k)
{
    uint8_t *level = levels->level;
    unsigned run = 1, wait = 0;
    bool is_data = k >= levels->data_begin && k < levels->data_end;
    level[k] = !level[k];
    while (run <= k && level[k - run] == level[k])
        run++;
    if (k < levels->stuffed && run < 6)
        wait = 6 - (level[k] == 0 ? run : 0);
    return first_bits_ns(bus, levels, k + 1) +
           wait * (is_data ? bus->times.data_ns : bus->times.bit_ns) +
           (ERROR_FLAG_BITS + ERROR_DELIMITER) * bus->times.bit_ns;
}

/*
 * The waiting frame that begins next, if one can until time_ns: the first to be ready, of those the
 * one that wins.
 */
static bool begin_next(struct bus *bus, uint64_t time_ns)
{
    uint64_t idle_ns = bus->idle_ns > bus->now_ns ? bus->idle_ns : bus->now_ns;
    uint64_t first_ns = UINT64_MAX;
    unsigned winner = 0;
    strike_ports(bus, idle_ns < time_ns ? idle_ns : time_ns);
    for (unsigned i = 0; i < bus->waiting_count; i++) {
        uint64_t at_ns = ready_ns(bus, bus->waiting[i], idle_ns);
        if (at_ns <= first_ns && at_ns != UINT64_MAX) {
            first_ns = at_ns;
            winner = i; /* the last of several is the one with the lowest identifier */
        }
    }
    if (first_ns > time_ns)
        return false;
    const struct can_frame *frame = &bus->waiting[winner]->frame;
    const struct frame_length length = frame_bits_count_port(&bus->tables, frame, bus_is_fd(bus));
    uint64_t length_ns = frame_bits_ns(&bus->times, &length);
    draw_verdict(bus, bus->waiting[winner], first_ns, length.nominal + length.data);
    if (bus->verdict.corrupt_bit != 0) {
        struct frame_levels levels;
        frame_levels_set(&levels, frame, bus_is_fd(bus));
        length_ns = until_error_ends_ns(bus, &levels, bus->verdict.corrupt_bit);
    }
    bus_put_on_wire(bus, winner, first_ns, length_ns);
    return true;
}

static void suspend_if_passive(struct bus *bus, unsigned port)
{
    if (bus_get_confinement(bus, port) == BUS_PASSIVE)
        bus->port[port].suspend_until_ns = bus->idle_ns + SUSPEND_BITS * bus->times.bit_ns;
}

/*
 * Back among the waiting ones, with its old rank and age; or lost, when that was one error too
 * many.
 */
static void send_again(struct bus *bus, unsigned errors)
{
    unsigned port = bus->wire->port;
    struct bus_port *p = &bus->port[port];
    p->transmit_errors += errors;
    bus->is_unwell = true;
    if (p->transmit_errors >= OFF_ERRORS)
        p->off_until_ns = bus->idle_ns + RECOVERY_BITS * bus->times.bit_ns;
    if (bus_get_confinement(bus, port) == BUS_OFF) {
        lose_waiting(bus, port);
        bus->counts.off_lost++;
        return;
    }
    bus->wire->is_repeat = true;
    *bus_make_room(bus, bus->wire->order, port) = *bus->wire;
    suspend_if_passive(bus, port);
}

static void end_bad(struct bus *bus)
{
    bool was_heard = false;
    unsigned errors = TRANSMIT_ERROR_STEP;
    bus->counts.error_frames++;
    for (unsigned i = 0; i < bus->port_count; i++) {
        if (i == bus->wire->port || !is_connected(bus, i, bus->now_ns))
            continue;
        was_heard = true;
        if (bus->port[i].receive_errors < RECEIVE_ERRORS_MAX)
            bus->port[i].receive_errors++;
    }
    /* A passive node that nobody acknowledges is alone: its counter rises no further. */
    if (!was_heard && bus->port[bus->wire->port].transmit_errors >= PASSIVE_ERRORS)
        errors = 0;
    send_again(bus, errors);
}

static void deliver_to_connected(struct bus *bus)
{
    for (unsigned i = 0; i < bus->port_count; i++) {
        struct bus_port *port = &bus->port[i];
        if (i == bus->wire->port || !is_connected(bus, i, bus->now_ns))
            continue;
        if (port->receive_errors > 0)
            port->receive_errors--;
        if (!bus->verdict.is_dropped)
            bus_deliver(bus, port, &bus->wire->frame);
    }
}

static void end_good(struct bus *bus)
{
    struct bus_port *sender = &bus->port[bus->wire->port];
    bus_count_frame(bus);
    if (bus->verdict.is_dropped)
        bus->counts.dropped++;
    suspend_if_passive(bus, bus->wire->port);
    if (sender->transmit_errors > 0)
        sender->transmit_errors--;
    if (bus->verdict.is_duplicated) {
        uint64_t error_ns = bus->times.bit_ns * (ERROR_FLAG_BITS + ERROR_DELIMITER);
        bus->counts.duplicated++;
        bus->idle_ns += error_ns;
        bus->counts.busy_ns += error_ns;
        send_again(bus, TRANSMIT_ERROR_STEP);
    }
    deliver_to_connected(bus);
}

/* Somebody else is there to acknowledge. */
static bool is_acknowledged(const struct bus *bus)
{
    for (unsigned i = 0; i < bus->port_count; i++)
        if (i != bus->wire->port && is_connected(bus, i, bus->now_ns))
            return true;
    return false;
}

static void end_frame(struct bus *bus)
{
    bus->now_ns = bus->frame_end_ns;
    bus->on_wire = false;
    strike_ports(bus, bus->now_ns);
    if (bus->verdict.corrupt_bit != 0 || !is_connected(bus, bus->wire->port, bus->now_ns) ||
        !is_acknowledged(bus))
        end_bad(bus);
    else
        end_good(bus);
    bus->verdict = (struct bus_verdict){0};
}

/* Nothing is left behind that the simple bus would not know. */
static bool is_unwell(const struct bus *bus)
{
    for (unsigned i = 0; i < bus->waiting_count; i++)
        if (bus->waiting[i]->since_ns > bus->now_ns)
            return true;
    for (unsigned i = 0; i < bus->port_count; i++) {
        const struct bus_port *port = &bus->port[i];
        if (port->transmit_errors > 0 || port->receive_errors > 0 || port->off_until_ns > 0 ||
            port->suspend_until_ns > bus->now_ns)
            return true;
    }
    return bus->on_wire &&
           bus->verdict.corrupt_bit + bus->verdict.is_dropped + bus->verdict.is_duplicated > 0;
}

static void retire_faults(struct bus *bus)
{
    for (unsigned i = 0; i < bus->fault_count; i++) {
        struct bus_fault_state *state = &bus->fault[i];
        if (bus->now_ns >= end_of(&state->fault) ||
            (state->fault.kind == BUS_FAULT_ERROR_PASSIVE && state->struck > 0))
            state->done = true;
    }
    find_first_fault(bus);
}

void bus_run_faulty(struct bus *bus, uint64_t time_ns)
{
    while (bus->on_wire || begin_next(bus, time_ns)) {
        if (bus->frame_end_ns > time_ns)
            break;
        end_frame(bus);
    }
    bus->now_ns = time_ns;
    strike_ports(bus, time_ns);
    retire_faults(bus);
    bus->is_unwell = is_unwell(bus);
}
