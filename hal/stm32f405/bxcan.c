#include "stm32f405/bxcan.h"

#include "stm32f405/bxcan_registers.h"
#include "stm32f405/chip.h"

#include <string.h>

/* Reads of a register; at 168 MHz some 2 ms. The controller answers within a few bits, the bus when it is idle. */
#define ANSWER_READS 50000U

#define QUANTA_MIN 8U
#define QUANTA_MAX 25U
#define TS2_MAX    8U
#define SJW_MAX    4U
#define BRP_MAX    1024U

static uint32_t read(const struct bxcan *can, uint32_t offset)
{
    return chip_read(can->base + offset);
}

static void write(const struct bxcan *can, uint32_t offset, uint32_t value)
{
    chip_write(can->base + offset, value);
}

/* ---- bit timing ---- */

/* Thousandths of a bit between the sample point of quanta with so many behind it and 7/8. */
static uint32_t sample_error(uint32_t quanta, uint32_t behind)
{
    const uint32_t sample = 1000U * (quanta - behind) / quanta;

    return sample > 875U ? sample - 875U : 875U - sample;
}

/* A bit: 1 quantum, TS1, the sample, TS2. */
static uint32_t timing_of(uint32_t divider, uint32_t quanta, uint32_t behind)
{
    return BXCAN_BTR_BRP(divider) | BXCAN_BTR_TS1(quanta - 1U - behind) | BXCAN_BTR_TS2(behind) |
           BXCAN_BTR_SJW(behind < SJW_MAX ? behind : SJW_MAX);
}

uint32_t bxcan_timing(uint32_t clock_hz, uint32_t bitrate)
{
    uint32_t best = 0, best_error = UINT32_MAX;

    for (uint32_t quanta = QUANTA_MAX; quanta >= QUANTA_MIN && bitrate > 0; quanta--) {
        const uint32_t behind = (quanta + 4U) / 8U;
        const uint64_t rate = (uint64_t)bitrate * quanta;
        const uint32_t ts1 = quanta - 1U - behind;

        if (rate > clock_hz || clock_hz % rate != 0 || clock_hz / rate > BRP_MAX || ts1 > 16U ||
            behind > TS2_MAX)
            continue;
        if (sample_error(quanta, behind) < best_error) {
            best_error = sample_error(quanta, behind);
            best = timing_of((uint32_t)(clock_hz / rate), quanta, behind);
        }
    }
    return best;
}

/* ---- start ---- */

static void accept_everything(const struct bxcan *can)
{
    write(can, BXCAN_FR1(0), BXCAN_FILTER(0, 0));
    write(can, BXCAN_FR2(0), BXCAN_FILTER(0, 0));
    write(can, BXCAN_FA1R, 1);
}

/* Two nodes a bank; the last may be there twice. */
static void accept_nodes(const struct bxcan *can, const struct bxcan_config *config)
{
    for (unsigned i = 0; i < config->nodes; i += 2) {
        const unsigned second = i + 1 < config->nodes ? i + 1 : i;

        write(can, BXCAN_FR1(i / 2), BXCAN_FILTER(config->node[i], 0x7F));
        write(can, BXCAN_FR2(i / 2), BXCAN_FILTER(config->node[second], 0x7F));
    }
    write(can, BXCAN_FA1R, (1U << (config->nodes + 1) / 2) - 1U);
}

/* All banks: 16 bits, masks, first FIFO. */
static void set_filters(const struct bxcan *can, const struct bxcan_config *config)
{
    chip_change(can->base + BXCAN_FMR, 0, BXCAN_FMR_INIT);
    write(can, BXCAN_FA1R, 0);
    write(can, BXCAN_FM1R, 0);
    write(can, BXCAN_FS1R, 0);
    write(can, BXCAN_FFA1R, 0);
    if (config->nodes == 0)
        accept_everything(can);
    else
        accept_nodes(can, config);
    chip_change(can->base + BXCAN_FMR, BXCAN_FMR_INIT, 0);
}

/* By priority, not in the order of requests; repeats until acknowledged; bus-off is ours to end. */
static bool enter_start(const struct bxcan *can)
{
    write(can, BXCAN_MCR, BXCAN_MCR_INRQ);
    return chip_wait(can->base + BXCAN_MSR, BXCAN_MSR_INAK | BXCAN_MSR_SLAK, BXCAN_MSR_INAK,
                     ANSWER_READS);
}

/* Leaves the start-up mode: the controller joins when it has heard 11 recessive bits. */
static bool join(const struct bxcan *can)
{
    chip_change(can->base + BXCAN_MCR, BXCAN_MCR_INRQ, 0);
    return chip_wait(can->base + BXCAN_MSR, BXCAN_MSR_INAK, 0, ANSWER_READS);
}

bool bxcan_open(struct bxcan *can, const struct bxcan_config *config)
{
    const uint32_t timing = bxcan_timing(config->clock_hz, config->bitrate);

    memset(can, 0, sizeof *can);
    can->base = config->base;
    can->state = BXCAN_ABSENT;
    if (timing == 0 || config->nodes > BXCAN_NODES_MAX || !enter_start(can))
        return false;
    write(can, BXCAN_BTR, timing);
    set_filters(can, config);
    write(can, BXCAN_IER, BXCAN_IER_TRANSMIT | BXCAN_IER_RECEIVE | BXCAN_IER_OVERRUN);
    can->state = join(can) ? BXCAN_ON : BXCAN_WAITING;
    return true;
}

/* ---- sending ---- */

static bool is_in_mailbox(const struct bxcan *can, uint16_t id)
{
    for (unsigned i = 0; i < BXCAN_MAILBOXES; i++) {
        if (can->is_full[i] && can->mailbox[i].id == id)
            return true;
    }
    return false;
}

/* The first of the queue that may go into a mailbox; queued: none. */
static unsigned next_to_go(const struct bxcan *can)
{
    unsigned at = 0;

    while (at < can->queued && is_in_mailbox(can, can->queue[at].id))
        at++;
    return at;
}

static struct can_frame take_from_queue(struct bxcan *can, unsigned at)
{
    const struct can_frame frame = can->queue[at];

    can->queued--;
    memmove(&can->queue[at], &can->queue[at + 1], (can->queued - at) * sizeof frame);
    return frame;
}

/* Before or behind those of the same identifier. There is room. */
static void put_into_queue(struct bxcan *can, const struct can_frame *frame, bool behind)
{
    unsigned at = 0;

    while (at < can->queued && (can_rank(can->queue[at].id) < can_rank(frame->id) ||
                                (behind && can->queue[at].id == frame->id)))
        at++;
    memmove(&can->queue[at + 1], &can->queue[at], (can->queued - at) * sizeof *frame);
    can->queue[at] = *frame;
    can->queued++;
}

static uint32_t word_of(const uint8_t *byte)
{
    return (uint32_t)byte[0] | (uint32_t)byte[1] << 8 | (uint32_t)byte[2] << 16 |
           (uint32_t)byte[3] << 24;
}

static void load_mailbox(struct bxcan *can, unsigned i, const struct can_frame *frame)
{
    can->mailbox[i] = *frame;
    can->is_full[i] = true;
    can->is_wanted_back[i] = false;
    write(can, BXCAN_TDT(i), frame->length);
    write(can, BXCAN_TDL(i), word_of(frame->data));
    write(can, BXCAN_TDH(i), word_of(frame->data + 4));
    write(can, BXCAN_TI(i),
          BXCAN_I_ID(frame->id & CAN_ID_MASK) | BXCAN_TI_TXRQ |
              (can_is_remote(frame) ? BXCAN_I_REMOTE : 0));
}

/* The mailbox with the least urgent frame. */
static unsigned least_urgent(const struct bxcan *can)
{
    unsigned last = 0;

    for (unsigned i = 1; i < BXCAN_MAILBOXES; i++) {
        if (can_rank(can->mailbox[i].id) > can_rank(can->mailbox[last].id))
            last = i;
    }
    return last;
}

/* All mailboxes are full: makes room if what waits is more urgent than any of them. */
static void make_room(struct bxcan *can, uint16_t id)
{
    const unsigned last = least_urgent(can);

    for (unsigned i = 0; i < BXCAN_MAILBOXES; i++) {
        if (can_rank(can->mailbox[i].id) < can_rank(id) || can->is_wanted_back[i])
            return;
    }
    can->is_wanted_back[last] = true;
    write(can, BXCAN_TSR, BXCAN_TSR_ABRQ(last));
}

static void fill_mailboxes(struct bxcan *can)
{
    for (unsigned i = 0; i < BXCAN_MAILBOXES; i++) {
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
static void empty_mailbox(struct bxcan *can, unsigned i, bool sent)
{
    if (!can->is_full[i])
        return;
    can->is_full[i] = false;
    if (sent) {
        can->counts.sent++;
    } else if (can->is_wanted_back[i] && can->state == BXCAN_ON) {
        can->counts.taken_back++;
        put_into_queue(can, &can->mailbox[i], false);
    } else {
        can->counts.dropped++;
    }
}

void bxcan_interrupt_sent(struct bxcan *can)
{
    const uint32_t before = chip_lock();
    const uint32_t status = read(can, BXCAN_TSR);

    for (unsigned i = 0; i < BXCAN_MAILBOXES; i++) {
        if ((status & BXCAN_TSR_RQCP(i)) == 0)
            continue;
        write(can, BXCAN_TSR, BXCAN_TSR_RQCP(i));
        empty_mailbox(can, i, (status & BXCAN_TSR_TXOK(i)) != 0);
    }
    if (can->state == BXCAN_ON)
        fill_mailboxes(can);
    chip_unlock(before);
}

/* One place stays free for a frame that is taken back. */
static bool send(void *context, const struct can_frame *frame)
{
    struct bxcan *can = context;
    const uint32_t before = chip_lock();
    const bool good = can->state == BXCAN_ON && can->queued < BXCAN_QUEUE_MAX - 1;

    if (good) {
        put_into_queue(can, frame, true);
        fill_mailboxes(can);
    }
    chip_unlock(before);
    return good;
}

/* ---- receiving ---- */

static void unpack(struct can_frame *frame, uint32_t low, uint32_t high)
{
    for (unsigned i = 0; i < 4; i++) {
        frame->data[i] = (uint8_t)(low >> 8U * i);
        frame->data[i + 4] = (uint8_t)(high >> 8U * i);
    }
}

/* False: the FIFO's head is no data frame with 11 bits. Bytes behind the frame's length are 0. */
static bool read_head(const struct bxcan *can, struct can_frame *frame)
{
    const uint32_t identifier = read(can, BXCAN_RI);
    const uint32_t length = BXCAN_LENGTH(read(can, BXCAN_RDT));

    if ((identifier & (BXCAN_I_LONG | BXCAN_I_REMOTE)) != 0)
        return false;
    *frame = (struct can_frame){.id = (uint16_t)BXCAN_ID_OF(identifier)};
    frame->length = (uint8_t)(length < CAN_CLASSIC_MAX ? length : CAN_CLASSIC_MAX);
    unpack(frame, read(can, BXCAN_RDL), read(can, BXCAN_RDH));
    memset(frame->data + frame->length, 0, (size_t)CAN_CLASSIC_MAX - frame->length);
    return true;
}

static void keep(struct bxcan *can, const struct can_frame *frame)
{
    const unsigned next = (can->behind + 1) % BXCAN_RECEIVED_MAX;

    if (next == can->first) {
        can->counts.lost++;
        return;
    }
    can->received[can->behind] = *frame;
    can->behind = next;
    can->counts.received++;
}

/* At most as many as the FIFO holds: more raise the interrupt again. */
void bxcan_interrupt_received(struct bxcan *can)
{
    struct can_frame frame;

    for (unsigned i = 0; i < BXCAN_MAILBOXES; i++) {
        const uint32_t status = read(can, BXCAN_RF0R);

        if ((status & BXCAN_RF_OVERRUN) != 0) {
            can->counts.overruns++;
            write(can, BXCAN_RF0R, BXCAN_RF_OVERRUN);
        }
        if ((status & BXCAN_RF_PENDING_MASK) == 0)
            return;
        if (read_head(can, &frame))
            keep(can, &frame);
        write(can, BXCAN_RF0R, BXCAN_RF_RELEASE);
        if (!chip_wait(can->base + BXCAN_RF0R, BXCAN_RF_RELEASE, 0, ANSWER_READS))
            return;
    }
}

static bool receive(void *context, struct can_frame *frame)
{
    struct bxcan *can = context;
    const uint32_t before = chip_lock();
    const bool any = can->first != can->behind;

    if (any) {
        *frame = can->received[can->first];
        can->first = (can->first + 1) % BXCAN_RECEIVED_MAX;
    }
    chip_unlock(before);
    return any;
}

struct can_port bxcan_get_port(struct bxcan *can)
{
    return (struct can_port){.send = send, .receive = receive, .context = can};
}

/* ---- what happens to the bus ---- */

/* Old setpoints must not be sent when the bus is back. */
static void drop_everything(struct bxcan *can)
{
    can->counts.dropped += can->queued;
    can->queued = 0;
    for (unsigned i = 0; i < BXCAN_MAILBOXES; i++) {
        if (can->is_full[i])
            write(can, BXCAN_TSR, BXCAN_TSR_ABRQ(i));
    }
}

static void leave_bus(struct bxcan *can)
{
    can->counts.bus_offs++;
    can->state = BXCAN_BUS_OFF;
    drop_everything(can);
    chip_change(can->base + BXCAN_MCR, 0, BXCAN_MCR_INRQ);
}

static void count_error(struct bxcan *can)
{
    const uint32_t code = BXCAN_ESR_LAST(read(can, BXCAN_ESR));

    /* The code stays until it is overwritten with the one the controller never sets. */
    if (code == BXCAN_ESR_LAST_UNUSED || code == 0)
        return;
    can->counts.error[code]++;
    write(can, BXCAN_ESR, BXCAN_ESR_LAST_UNUSED << 4);
}

/* The controller has to be led through its start-up mode; joining then counts the recessive bits. */
static void rejoin(struct bxcan *can)
{
    if ((read(can, BXCAN_MSR) & BXCAN_MSR_INAK) == 0)
        return;
    chip_change(can->base + BXCAN_MCR, BXCAN_MCR_INRQ, 0);
    can->state = BXCAN_REJOINING;
}

/* What was in mailboxes when the bus was lost has been given up by now. */
static void forget_mailboxes(struct bxcan *can)
{
    for (unsigned i = 0; i < BXCAN_MAILBOXES; i++)
        empty_mailbox(can, i, false);
}

static void watch_join(struct bxcan *can)
{
    const bool starting = (read(can, BXCAN_MSR) & BXCAN_MSR_INAK) != 0;
    const bool off = (read(can, BXCAN_ESR) & BXCAN_ESR_BUS_OFF) != 0;

    if (starting || off)
        return;
    forget_mailboxes(can);
    can->state = BXCAN_ON;
}

void bxcan_poll(struct bxcan *can)
{
    const uint32_t before = chip_lock();

    switch (can->state) {
    case BXCAN_ABSENT:
        break;
    case BXCAN_ON:
        count_error(can);
        if ((read(can, BXCAN_ESR) & BXCAN_ESR_BUS_OFF) != 0)
            leave_bus(can);
        break;
    case BXCAN_BUS_OFF:
        rejoin(can);
        break;
    case BXCAN_WAITING:
    case BXCAN_REJOINING:
        watch_join(can);
        break;
    }
    chip_unlock(before);
}

enum bxcan_state bxcan_get_state(const struct bxcan *can)
{
    return can->state;
}

const struct bxcan_counts *bxcan_get_counts(const struct bxcan *can)
{
    return &can->counts;
}

void bxcan_get_errors(const struct bxcan *can, unsigned *sending, unsigned *receiving)
{
    const uint32_t status = read(can, BXCAN_ESR);

    *sending = BXCAN_ESR_SENT(status);
    *receiving = BXCAN_ESR_HEARD(status);
}
