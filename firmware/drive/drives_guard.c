/*
 * Node guarding (CiA 301, 7.2.8.3.2.1): who has no heartbeat is asked for its state, once a period,
 * by a remote frame of the heartbeat's identifier. By that it knows of us, too: it takes us for
 * lost when nothing has come for its life time.
 *
 *     cycle    k            k + 1        ...  k + period
 *              node 1 | RTR node 2 | RTR      node 1 | RTR
 *                 answer       answer            answer, its toggle bit changed
 */
#include "base/assert.h"
#include "drive/drives_private.h"

#include <stddef.h>

#define ANSWER_LENGTH 1

uint32_t takt_drives_guard_cycles(const struct drives *d)
{
    const uint32_t nodes = d->count + d->io_count;
    return d->heartbeat_cycles > nodes ? d->heartbeat_cycles : nodes;
}

/* Rounded up: the node must not be told less than passes. */
uint32_t takt_drives_guard_ms(const struct drives *d)
{
    TAKT_ASSERT(d->cycle_us > 0);
    return (takt_drives_guard_cycles(d) * d->cycle_us + 999) / 1000;
}

/* The first answer has toggle bit 0. */
void takt_drives_begin_guard(struct drives *d, struct drives_guard *guard)
{
    d->guards = d->guards || guard->is_on;
    guard->toggle = NMT_TOGGLE;
}

/*
 * Guard k, of the drives and behind them of the I/O nodes, and its bus and node; NULL: it has not
 * been started.
 */
static const struct drives_guard *guard_of(const struct drives *d, unsigned k, unsigned *bus,
                                           uint8_t *node)
{
    const bool is_drive = k < d->count;
    const unsigned io = k - d->count;
    TAKT_ASSERT(k < d->count + d->io_count);
    *bus = is_drive ? drives_bus_of(d, k) : drives_io_bus_of(d, io);
    *node = is_drive ? d->node[k] : d->wiring[io].node;
    if (!(is_drive ? d->axis[k].started : d->io[io].started))
        return NULL;
    return is_drive ? &d->axis[k].guard : &d->io[io].guard;
}

/* One that is refused is missed, as if it had got lost. */
void takt_drives_send_guard(struct drives *d, const struct can_port *port)
{
    const unsigned turn = d->cycle % takt_drives_guard_cycles(d);
    const struct drives_guard *guard = NULL;
    struct can_frame frame;
    unsigned bus = 0;
    uint8_t node;
    if (turn < d->count + d->io_count)
        guard = guard_of(d, turn, &bus, &node);
    if (guard == NULL || !guard->is_on)
        return;
    takt_nmt_write_guard(&frame, node);
    (void)drives_send_frame(&port[bus], &frame);
}

static bool has_guard(const struct drives *d, unsigned bus)
{
    bool is_any = false;
    for (unsigned i = 0; i < d->count; i++)
        is_any = is_any || (d->axis[i].guard.is_on && drives_bus_of(d, i) == bus);
    for (unsigned i = 0; i < d->io_count; i++)
        is_any = is_any || (d->io[i].guard.is_on && drives_io_bus_of(d, i) == bus);
    return is_any;
}

bool takt_drives_are_guarding(const struct drives *d, unsigned bus)
{
    return d->guards && has_guard(d, bus);
}

uint32_t takt_drives_guard_bits(const struct drives *d, unsigned bus)
{
    return has_guard(d, bus) ? takt_drives_remote_bits() + drives_bits(d, ANSWER_LENGTH) : 0;
}
