/* FDCAN with its message memory, and the bus behind it (RM0433, chapter 56). */
#include "fdcan_model.h"

#include "chip_model.h"
#include "stm32h743/fdcan_registers.h"

#include <string.h>

#define SIZE         0x400U
#define CCU          0x4000A800U
#define MEMORY_AT    (FDCAN_MEMORY - CCU)
#define WORDS        2560U
#define ANSWER_READS 40U
#define NOBODY       32U

struct can_model can_model;
struct fdcan_model fdcan_model;

const uint32_t can_model_clock_hz = 80000000;
const unsigned can_model_fifo = 32;

static uint32_t word[SIZE / 4], memory[WORDS], calibration;
static unsigned sending, first, level;
static bool is_off;
static uint64_t asked_at; /* reads when INIT was last changed */

static uint32_t *at(uint32_t offset)
{
    return &word[offset / 4];
}

static bool is_starting(void)
{
    return (*at(FDCAN_CCCR) & FDCAN_CCCR_INIT) != 0;
}

static bool may_change(void)
{
    return is_starting() && (*at(FDCAN_CCCR) & FDCAN_CCCR_CCE) != 0;
}

static void empty(void)
{
    *at(FDCAN_TXBRP) = *at(FDCAN_TXBTO) = *at(FDCAN_TXBCF) = 0;
    first = level = 0;
    sending = NOBODY;
}

static void reset(void)
{
    can_model = (struct can_model){.bus_is_idle = true};
    fdcan_model = (struct fdcan_model){0};
    memset(word, 0, sizeof word);
    memset(memory, 0xA5, sizeof memory);
    *at(FDCAN_CCCR) = FDCAN_CCCR_INIT;
    *at(FDCAN_NBTP) = 0x06000A03U;
    *at(FDCAN_DBTP) = 0x00000A33U;
    *at(FDCAN_PSR) = 0x00000707U;
    calibration = 0;
    is_off = false;
    asked_at = 0;
    empty();
}

static bool is_in_step(void)
{
    return !is_starting() && !is_off && can_model.bus_is_idle &&
           chip_model_reads() - asked_at >= ANSWER_READS;
}

static uint32_t take_status(void)
{
    const uint32_t status =
        *at(FDCAN_PSR) | (is_in_step() ? 1U << 3 : 0) | (is_off ? FDCAN_PSR_BUS_OFF : 0);

    *at(FDCAN_PSR) |= 0x707U;
    return status;
}

static uint32_t read(uint32_t offset)
{
    if (can_model.is_absent)
        return 0;
    if (offset == FDCAN_PSR)
        return take_status();
    if (offset == FDCAN_RXF0S)
        return level | first << 8 | ((*at(FDCAN_IR) & FDCAN_IR_LOST) != 0 ? FDCAN_RXF0S_LOST : 0);
    return *at(offset);
}

static void write_modes(uint32_t value)
{
    if (((value ^ *at(FDCAN_CCCR)) & (FDCAN_CCCR_FDOE | FDCAN_CCCR_BRSE)) != 0 && !may_change())
        chip_model_break("the modes are changed outside of the start-up mode");
    if ((value & FDCAN_CCCR_CCE) != 0 && (value & FDCAN_CCCR_INIT) == 0)
        chip_model_break("changes are allowed while the start-up mode is left");
    if (((value ^ *at(FDCAN_CCCR)) & FDCAN_CCCR_INIT) != 0)
        asked_at = chip_model_reads();
    *at(FDCAN_CCCR) = value;
    if ((value & FDCAN_CCCR_CCE) != 0)
        empty();
}

/* The request to mailbox i is over. */
static void finish(unsigned i, bool sent)
{
    *at(FDCAN_TXBRP) &= ~(1U << i);
    *at(FDCAN_TXBTO) |= (uint32_t)sent << i;
    if (((*at(FDCAN_TXBCR) >> i) & 1U) != 0)
        *at(FDCAN_TXBCF) |= 1U << i;
    if (sent && ((*at(FDCAN_TXBTIE) >> i) & 1U) != 0)
        *at(FDCAN_IR) |= FDCAN_IR_SENT;
    if (((*at(FDCAN_TXBCF) & *at(FDCAN_TXBCIE)) >> i & 1U) != 0)
        *at(FDCAN_IR) |= FDCAN_IR_CANCELLED;
    *at(FDCAN_TXBCR) &= ~(1U << i);
}

static void request(uint32_t value)
{
    if ((value & *at(FDCAN_TXBRP)) != 0)
        chip_model_break("a mailbox is filled while its frame waits to be sent");
    if (value >= 1U << ((*at(FDCAN_TXBC) >> 16) & 63U))
        chip_model_break("there is no such mailbox");
    *at(FDCAN_TXBRP) |= value;
    *at(FDCAN_TXBTO) &= ~value;
    *at(FDCAN_TXBCF) &= ~value;
}

static void call_back(uint32_t value)
{
    *at(FDCAN_TXBCR) |= value & *at(FDCAN_TXBRP);
    for (unsigned i = 0; i < NOBODY; i++) {
        if ((*at(FDCAN_TXBCR) >> i & 1U) != 0 && i != sending)
            finish(i, false);
    }
}

static void release(uint32_t index)
{
    if (level == 0 || index != first) {
        chip_model_break("another element than the oldest is given back");
        return;
    }
    first = (first + 1) % can_model_fifo;
    level--;
}

static bool is_protected(uint32_t offset)
{
    return offset == FDCAN_NBTP || offset == FDCAN_DBTP || offset == FDCAN_TDCR ||
           (offset >= FDCAN_GFC && offset <= FDCAN_XIDFC) || offset == FDCAN_RXF0C ||
           offset == FDCAN_RXESC || offset == FDCAN_TXBC || offset == FDCAN_TXESC;
}

static void write(uint32_t offset, uint32_t value)
{
    if (can_model.is_absent)
        return;
    if (is_protected(offset) && !may_change())
        chip_model_break("a protected register is written outside of the start-up mode");
    if (offset == FDCAN_CCCR)
        write_modes(value);
    else if (offset == FDCAN_IR)
        *at(FDCAN_IR) &= ~value;
    else if (offset == FDCAN_TXBAR)
        request(value);
    else if (offset == FDCAN_TXBCR)
        call_back(value);
    else if (offset == FDCAN_RXF0A)
        release(value);
    else
        *at(offset) = value;
}

const struct chip_block chip_can = {FDCAN_1, SIZE, read, write, reset};

static uint32_t read_memory(uint32_t offset)
{
    return offset < MEMORY_AT ? calibration : memory[(offset - MEMORY_AT) / 4];
}

static void write_memory(uint32_t offset, uint32_t value)
{
    if (offset >= MEMORY_AT)
        memory[(offset - MEMORY_AT) / 4] = value;
    else if (!may_change() && !can_model.is_absent)
        chip_model_break("the calibration is set outside of the start-up mode");
    else
        calibration = value;
}

static void reset_memory(void)
{
    /* Whatever power-on leaves there: reset has done it. */
}

const struct chip_block chip_can_memory = {CCU, MEMORY_AT + 4U * WORDS, read_memory, write_memory,
                                           reset_memory};

/* ---- the bus ---- */

static const uint8_t lengths[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};

static uint32_t *element(uint32_t list, unsigned i)
{
    return &memory[((list & 0xFFFCU) >> 2) + i * FDCAN_ELEMENT_WORDS];
}

static struct can_frame frame_of(const uint32_t *from)
{
    const bool is_remote = (from[0] & FDCAN_E0_REMOTE) != 0;
    struct can_frame frame = {
        .id = (uint16_t)(FDCAN_E0_ID_OF(from[0]) | (is_remote ? CAN_REMOTE : 0)),
        .length = lengths[FDCAN_E1_DLC_OF(from[1])]};

    for (unsigned i = 0; i < can_data_length(&frame); i++)
        frame.data[i] = (uint8_t)(from[2 + i / 4] >> 8 * (i % 4));
    return frame;
}

/* The lowest identifier wins, of equal ones the lowest mailbox. */
bool can_model_begin(struct can_frame *frame)
{
    const uint32_t *won = NULL;

    sending = NOBODY;
    for (unsigned i = 0; i < NOBODY && is_in_step(); i++) {
        const uint32_t *box = element(*at(FDCAN_TXBC), i);

        if ((*at(FDCAN_TXBRP) >> i & 1U) == 0 ||
            (won != NULL && FDCAN_E0_ID_OF(box[0]) >= FDCAN_E0_ID_OF(won[0])))
            continue;
        won = box;
        sending = i;
    }
    if (won == NULL)
        return false;
    *frame = frame_of(won);
    fdcan_model.sent_fd = (won[1] & FDCAN_E1_FD) != 0 && (*at(FDCAN_CCCR) & FDCAN_CCCR_FDOE) != 0;
    fdcan_model.sent_fast = fdcan_model.sent_fd && (won[1] & FDCAN_E1_FAST) != 0 &&
                            (*at(FDCAN_CCCR) & FDCAN_CCCR_BRSE) != 0;
    return true;
}

void can_model_end(bool acknowledged)
{
    const unsigned i = sending;

    sending = NOBODY;
    if (i != NOBODY && (acknowledged || (*at(FDCAN_TXBCR) >> i & 1U) != 0))
        finish(i, acknowledged);
}

bool can_model_transfer(struct can_frame *frame)
{
    if (!can_model_begin(frame))
        return false;
    can_model_end(true);
    return true;
}

static bool matches(uint32_t filter, uint16_t id)
{
    return filter >> 30 == 2U && (filter >> 27 & 7U) == 1U &&
           (((filter >> 16) ^ id) & filter & CAN_ID_MASK) == 0;
}

static bool is_accepted(uint16_t id)
{
    const uint32_t list = *at(FDCAN_SIDFC), rest = *at(FDCAN_GFC) >> 4 & 3U;
    const uint32_t *filter = &memory[(list & 0xFFFCU) >> 2];

    if ((can_model.extended_or_remote == 1 && (*at(FDCAN_GFC) & 0xDU) == 0xDU) ||
        (can_model.extended_or_remote == 2 && (*at(FDCAN_GFC) & 2U) != 0))
        return false;
    for (unsigned i = 0; i < (list >> 16 & 0xFFU); i++) {
        if (matches(filter[i], id))
            return true;
    }
    return rest == 0;
}

static uint32_t code_of(const struct can_frame *frame)
{
    uint32_t code = 0;

    if (!fdcan_model.hears_fd)
        return frame->length;
    while (lengths[code] < frame->length)
        code++;
    return code;
}

static void put(const struct can_frame *frame)
{
    uint32_t *to = element(*at(FDCAN_RXF0C), (first + level) % can_model_fifo);
    const uint32_t code = code_of(frame);

    memset(to, 0xA5, FDCAN_ELEMENT_WORDS * sizeof *to);
    to[0] = FDCAN_E0_ID(frame->id);
    to[1] = FDCAN_E1_DLC(code) | (fdcan_model.hears_fd ? FDCAN_E1_FD | FDCAN_E1_FAST : 0);
    for (unsigned i = 0; i < CAN_DATA_MAX && i < lengths[code]; i++) {
        to[2 + i / 4] &= ~(0xFFU << 8 * (i % 4));
        to[2 + i / 4] |= (uint32_t)frame->data[i] << 8 * (i % 4);
    }
    level++;
}

bool can_model_hear(const struct can_frame *frame)
{
    if (!is_in_step() || !is_accepted(frame->id))
        return false;
    *at(FDCAN_IR) |= FDCAN_IR_RECEIVED;
    if (level == (*at(FDCAN_RXF0C) >> 16 & 0x7FU))
        *at(FDCAN_IR) |= FDCAN_IR_LOST;
    else
        put(frame);
    return true;
}

/* It goes to its start-up mode by itself. */
void can_model_lose_bus(void)
{
    is_off = true;
    sending = NOBODY;
    *at(FDCAN_CCCR) |= FDCAN_CCCR_INIT;
}

/* Hears the recessive bits only when it has left its start-up mode. */
void can_model_calm(void)
{
    if (!is_starting())
        is_off = false;
}

void can_model_set_errors(unsigned last, unsigned sending_errors, unsigned receiving_errors)
{
    *at(FDCAN_PSR) = (*at(FDCAN_PSR) & ~7U) | last;
    *at(FDCAN_ECR) = sending_errors | receiving_errors << 8;
}

void fdcan_model_set_data_error(unsigned last)
{
    *at(FDCAN_PSR) = (*at(FDCAN_PSR) & ~0x700U) | last << 8;
}

static bool asks(unsigned line)
{
    const uint32_t flags = *at(FDCAN_IR) & *at(FDCAN_IE);

    return (*at(FDCAN_ILE) >> line & 1U) != 0 &&
           (flags & (line == 0 ? ~*at(FDCAN_ILS) : *at(FDCAN_ILS))) != 0;
}

bool can_model_asks_sent(void)
{
    return asks(0);
}

bool can_model_asks_received(void)
{
    return asks(1);
}

unsigned can_model_waiting(void)
{
    unsigned count = 0;

    for (unsigned i = 0; i < NOBODY; i++)
        count += *at(FDCAN_TXBRP) >> i & 1U;
    return count;
}

void can_model_get_bit(struct can_model_bit *bit)
{
    const uint32_t timing = *at(FDCAN_NBTP);

    bit->divider = (timing >> 16 & 511U) + 1U;
    bit->sampled = 1U + (timing >> 8 & 255U) + 1U;
    bit->quanta = bit->sampled + (timing & 127U) + 1U;
    bit->jump = (timing >> 25) + 1U;
}

bool fdcan_model_get_data_bit(struct can_model_bit *bit, unsigned *offset)
{
    const uint32_t timing = *at(FDCAN_DBTP), modes = FDCAN_CCCR_FDOE | FDCAN_CCCR_BRSE;

    bit->divider = (timing >> 16 & 31U) + 1U;
    bit->sampled = 1U + (timing >> 8 & 31U) + 1U;
    bit->quanta = bit->sampled + (timing >> 4 & 15U) + 1U;
    bit->jump = (timing & 15U) + 1U;
    *offset = (timing & FDCAN_DBTP_TDC) != 0 ? *at(FDCAN_TDCR) >> 8 & 127U : 0;
    return (*at(FDCAN_CCCR) & modes) == modes;
}
