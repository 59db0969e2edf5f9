#include "stm32/can_controller.h"

#include "stm32/chip.h"

#include <string.h>

bool takt_can_controller_open(struct can_controller *can, const struct can_config *config)
{
    memset(can, 0, sizeof *can);
    can->state = CAN_ABSENT;
    if (config->rates.nominal == 0 ||
        takt_can_hardware_find_impossible(config->clock_hz, &config->rates) != 0 ||
        config->nodes > CAN_NODES_MAX || !takt_can_hardware_open(config))
        return false;
    can->state = takt_can_hardware_join() ? CAN_ON : CAN_WAITING;
    return true;
}

/* ---- sending ---- */

static bool is_in_mailbox(const struct can_controller *can, uint16_t id)
{
    for (unsigned i = 0; i < CAN_MAILBOXES; i++) {
        if (can->is_full[i] && can->mailbox[i].id == id)
            return true;
    }
    return false;
}

/* The first of the queue that may go into a mailbox; queued: none. */
static unsigned next_to_go(const struct can_controller *can)
{
    unsigned at = 0;

    while (at < can->queued && is_in_mailbox(can, can->queue[at].id))
        at++;
    return at;
}

static struct can_frame take_from_queue(struct can_controller *can, unsigned at)
{
    const struct can_frame frame = can->queue[at];

    can->queued--;
    memmove(&can->queue[at], &can->queue[at + 1], (can->queued - at) * sizeof frame);
    return frame;
}

/* Before or behind those of the same identifier. There is room. */
static void put_into_queue(struct can_controller *can, const struct can_frame *frame, bool behind)
{
    unsigned at = 0;

    while (at < can->queued && (can_rank(can->queue[at].id) < can_rank(frame->id) ||
                                (behind && can->queue[at].id == frame->id)))
        at++;
    memmove(&can->queue[at + 1], &can->queue[at], (can->queued - at) * sizeof *frame);
    can->queue[at] = *frame;
    can->queued++;
}

static void load_mailbox(struct can_controller *can, unsigned i, const struct can_frame *frame)
{
    can->mailbox[i] = *frame;
    can->is_full[i] = true;
    can->is_wanted_back[i] = false;
    takt_can_hardware_load(i, frame);
}

/* The mailbox with the least urgent frame. */
static unsigned least_urgent(const struct can_controller *can)
{
    unsigned last = 0;

    for (unsigned i = 1; i < CAN_MAILBOXES; i++) {
        if (can_rank(can->mailbox[i].id) > can_rank(can->mailbox[last].id))
            last = i;
    }
    return last;
}

/* All mailboxes are full: makes room if what waits is more urgent than any of them. */
static void make_room(struct can_controller *can, uint16_t id)
{
    const unsigned last = least_urgent(can);

    for (unsigned i = 0; i < CAN_MAILBOXES; i++) {
        if (can_rank(can->mailbox[i].id) < can_rank(id) || can->is_wanted_back[i])
            return;
    }
    can->is_wanted_back[last] = true;
    takt_can_hardware_take_back(last);
}

static void fill_mailboxes(struct can_controller *can)
{
    for (unsigned i = 0; i < CAN_MAILBOXES; i++) {
        const unsigned next = next_to_go(can);

        if (next == can->queued)
            return;
        if (!can->is_full[i]) {
            const struct can_frame frame = take_from_queue(can, next);

            load_mailbox(can, i, &frame);
        }
    }
    if (next_to_go(can) < can->queued && can->is_full[0] && can->is_full[1] && can->is_full[2])
        make_room(can, can->queue[next_to_go(can)].id);
}

/* A request to mailbox i is over: sent, or taken back. */
static void empty_mailbox(struct can_controller *can, unsigned i, bool sent)
{
    if (!can->is_full[i])
        return;
    can->is_full[i] = false;
    if (sent) {
        can->counts.sent++;
    } else if (can->is_wanted_back[i] && can->state == CAN_ON) {
        can->counts.taken_back++;
        put_into_queue(can, &can->mailbox[i], false);
    } else {
        can->counts.dropped++;
    }
}

void takt_can_controller_interrupt_sent(struct can_controller *can)
{
    const uint32_t before = takt_chip_lock();
    unsigned sent;
    const unsigned done = takt_can_hardware_take_done(&sent);

    for (unsigned i = 0; i < CAN_MAILBOXES; i++) {
        if ((done >> i & 1U) != 0)
            empty_mailbox(can, i, (sent >> i & 1U) != 0);
    }
    if (can->state == CAN_ON)
        fill_mailboxes(can);
    takt_chip_unlock(before);
}

/* One place stays free for a frame that is taken back. */
static bool send(void *context, const struct can_frame *frame)
{
    struct can_controller *can = context;
    const uint32_t before = takt_chip_lock();
    const bool good = can->state == CAN_ON && can->queued < CAN_QUEUE_MAX - 1;

    if (good) {
        put_into_queue(can, frame, true);
        fill_mailboxes(can);
    }
    takt_chip_unlock(before);
    return good;
}

/* ---- receiving ---- */

static void keep(struct can_controller *can, const struct can_frame *frame)
{
    const unsigned next = (can->behind + 1) % CAN_RECEIVED_MAX;

    if (next == can->first) {
        can->counts.lost++;
        return;
    }
    can->received[can->behind] = *frame;
    can->behind = next;
    can->counts.received++;
}

/* Until there is nothing left; an end all the same. */
void takt_can_controller_interrupt_received(struct can_controller *can)
{
    struct can_frame frame;

    for (unsigned i = 0; i < CAN_RECEIVED_MAX; i++) {
        enum can_heard heard;

        can->counts.overruns += takt_can_hardware_take_overrun();
        heard = takt_can_hardware_hear(&frame);
        if (heard == CAN_HEARD_NOTHING)
            return;
        if (heard == CAN_HEARD_FRAME)
            keep(can, &frame);
    }
}

static bool receive(void *context, struct can_frame *frame)
{
    struct can_controller *can = context;
    const uint32_t before = takt_chip_lock();
    const bool any = can->first != can->behind;

    if (any) {
        *frame = can->received[can->first];
        can->first = (can->first + 1) % CAN_RECEIVED_MAX;
    }
    takt_chip_unlock(before);
    return any;
}

struct can_port takt_can_controller_get_port(struct can_controller *can)
{
    return (struct can_port){.send = send, .receive = receive, .context = can};
}

/* ---- what happens to the bus ---- */

/* Old setpoints must not be sent when the bus is back. */
static void leave_bus(struct can_controller *can)
{
    can->counts.bus_offs++;
    can->counts.dropped += can->queued;
    can->queued = 0;
    can->state = CAN_BUS_OFF;
    takt_can_hardware_leave();
}

static void count_error(struct can_controller *can)
{
    const unsigned error = takt_can_hardware_take_error();

    if (error != 0)
        can->counts.error[error]++;
}

/* What was in mailboxes when the bus was lost has been given up by now. */
static void forget_mailboxes(struct can_controller *can)
{
    for (unsigned i = 0; i < CAN_MAILBOXES; i++)
        empty_mailbox(can, i, false);
}

static void watch_join(struct can_controller *can)
{
    if (!takt_can_hardware_takes_part())
        return;
    forget_mailboxes(can);
    can->state = CAN_ON;
}

void takt_can_controller_poll(struct can_controller *can)
{
    const uint32_t before = takt_chip_lock();

    switch (can->state) {
    case CAN_ABSENT:
        break;
    case CAN_ON:
        count_error(can);
        if (takt_can_hardware_is_off())
            leave_bus(can);
        break;
    case CAN_BUS_OFF:
        if (takt_can_hardware_rejoin())
            can->state = CAN_REJOINING;
        break;
    case CAN_WAITING:
    case CAN_REJOINING:
        watch_join(can);
        break;
    }
    takt_chip_unlock(before);
}

enum can_state takt_can_controller_get_state(const struct can_controller *can)
{
    return can->state;
}

const struct can_counts *takt_can_controller_get_counts(const struct can_controller *can)
{
    return &can->counts;
}
