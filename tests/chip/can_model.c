#include "can_model.h"

#include "chip_model.h"
#include "stm32f405/bxcan_registers.h"

#include <string.h>

#define SIZE         0x400U
#define ANSWER_READS 40U
#define NOBODY       3U
#define FIFO         3U

#define TSR_OF_MAILBOX(i) (0xFU << 8U * (i))

struct can_model can_model;

struct mailbox {
    uint32_t identifier, length, low, high;
};

static uint32_t mcr, msr, tsr, rf, ier, esr, btr, fmr, filter[5], bank[2 * BXCAN_BANKS];
static struct mailbox mailbox[3], fifo[FIFO];
static unsigned sending, pending;
static bool called_back[3];
static bool has_restarted; /* since the bus was lost */
static uint64_t asked_at;  /* reads when INRQ was last changed */

static void reset(void)
{
    can_model = (struct can_model){.bus_is_idle = true};
    mcr = 0x00010002U;
    msr = 0x00000C02U;
    tsr = 0x1C000000U;
    rf = ier = esr = 0;
    btr = 0x01230000U;
    fmr = 0x2A1C0E01U;
    memset(filter, 0, sizeof filter);
    memset(bank, 0, sizeof bank);
    memset(called_back, 0, sizeof called_back);
    sending = NOBODY;
    pending = 0;
}

static void enter_start(void)
{
    msr |= BXCAN_MSR_INAK;
    has_restarted = true;
}

/* Start-up mode is entered and left some time after it was asked for; left only on an idle bus. */
static void move_modes(void)
{
    if (chip_model_reads() - asked_at < ANSWER_READS)
        return;
    if ((mcr & BXCAN_MCR_SLEEP) == 0)
        msr &= ~BXCAN_MSR_SLAK;
    if ((mcr & BXCAN_MCR_INRQ) != 0 && sending == NOBODY)
        enter_start();
    else if ((mcr & BXCAN_MCR_INRQ) == 0 && can_model.bus_is_idle)
        msr &= ~BXCAN_MSR_INAK;
}

static uint32_t read_mailbox(uint32_t offset)
{
    const struct mailbox *box =
        offset >= BXCAN_RI ? &fifo[0] : &mailbox[(offset - BXCAN_TI(0)) / 0x10U];

    switch (offset % 0x10U) {
    case 0x0:
        return box->identifier;
    case 0x4:
        return box->length;
    case 0x8:
        return box->low;
    default:
        return box->high;
    }
}

static uint32_t read(uint32_t offset)
{
    if (can_model.is_absent)
        return 0;
    move_modes();
    if (offset >= BXCAN_TI(0) && offset <= BXCAN_RDH)
        return read_mailbox(offset);
    if (offset >= BXCAN_FR1(0))
        return bank[(offset - BXCAN_FR1(0)) / 4];
    switch (offset) {
    case BXCAN_MCR:
        return mcr;
    case BXCAN_MSR:
        return msr;
    case BXCAN_TSR:
        return tsr;
    case BXCAN_RF0R:
        return rf | pending;
    case BXCAN_IER:
        return ier;
    case BXCAN_ESR:
        return esr;
    case BXCAN_BTR:
        return btr;
    case BXCAN_FMR:
        return fmr;
    default:
        return 0;
    }
}

/* The request to mailbox i is over. */
static void finish(unsigned i, bool sent)
{
    called_back[i] = false;
    mailbox[i].identifier &= ~BXCAN_TI_TXRQ;
    tsr &= ~TSR_OF_MAILBOX(i);
    tsr |= BXCAN_TSR_RQCP(i) | BXCAN_TSR_EMPTY(i) | (sent ? BXCAN_TSR_TXOK(i) : 0);
}

static void write_tsr(uint32_t value)
{
    for (unsigned i = 0; i < 3; i++) {
        if ((value & BXCAN_TSR_RQCP(i)) != 0)
            tsr &= ~TSR_OF_MAILBOX(i);
        if ((value & BXCAN_TSR_ABRQ(i)) == 0 || (tsr & BXCAN_TSR_EMPTY(i)) != 0)
            continue;
        called_back[i] = true;
        if (sending != i)
            finish(i, false);
    }
}

static void write_mailbox(uint32_t offset, uint32_t value)
{
    const unsigned i = (offset - BXCAN_TI(0)) / 0x10U;

    if (i >= 3) {
        chip_model_break("a receive mailbox is written");
        return;
    }
    if ((tsr & BXCAN_TSR_EMPTY(i)) == 0)
        chip_model_break("a mailbox is written while its frame waits to be sent");
    if (offset % 0x10U == 0x4U) {
        mailbox[i].length = value;
    } else if (offset % 0x10U == 0x8U) {
        mailbox[i].low = value;
    } else if (offset % 0x10U == 0xCU) {
        mailbox[i].high = value;
    } else {
        mailbox[i].identifier = value;
        if ((value & BXCAN_TI_TXRQ) != 0)
            tsr &= ~(BXCAN_TSR_EMPTY(i) | TSR_OF_MAILBOX(i));
    }
}

static void release(void)
{
    if (pending == 0)
        return;
    pending--;
    memmove(&fifo[0], &fifo[1], (FIFO - 1) * sizeof fifo[0]);
}

static unsigned filter_number(uint32_t offset)
{
    return (offset - BXCAN_FM1R) / 8U;
}

static void write_filter(uint32_t offset, uint32_t value)
{
    if ((fmr & BXCAN_FMR_INIT) == 0)
        chip_model_break("a filter is set outside its start-up mode");
    if (offset >= BXCAN_FR1(0))
        bank[(offset - BXCAN_FR1(0)) / 4] = value;
    else
        filter[filter_number(offset)] = value;
}

static void write_mcr(uint32_t value)
{
    if (((value ^ mcr) & (BXCAN_MCR_INRQ | BXCAN_MCR_SLEEP)) != 0)
        asked_at = chip_model_reads();
    mcr = value;
}

static void write(uint32_t offset, uint32_t value)
{
    if (can_model.is_absent)
        return;
    move_modes();
    if (offset >= BXCAN_TI(0) && offset <= BXCAN_RDH)
        write_mailbox(offset, value);
    else if (offset == BXCAN_FMR)
        fmr = value;
    else if (offset >= BXCAN_FM1R)
        write_filter(offset, value);
    else if (offset == BXCAN_MCR)
        write_mcr(value);
    else if (offset == BXCAN_TSR)
        write_tsr(value);
    else if (offset == BXCAN_IER)
        ier = value;
    else if (offset == BXCAN_ESR)
        esr = (esr & ~0x70U) | (value & 0x70U);
    else if (offset == BXCAN_RF0R) {
        rf &= ~(value & 0x18U);
        if ((value & BXCAN_RF_RELEASE) != 0)
            release();
    } else if (offset == BXCAN_BTR) {
        if ((msr & BXCAN_MSR_INAK) == 0)
            chip_model_break("the bit timing is set outside the start-up mode");
        btr = value;
    }
}

const struct chip_block chip_can = {BXCAN_CAN1, SIZE, read, write, reset};

/* ---- the bus ---- */

static struct can_frame frame_of(const struct mailbox *box)
{
    const bool is_remote = (box->identifier & BXCAN_I_REMOTE) != 0;
    struct can_frame frame = {
        .id = (uint16_t)(BXCAN_ID_OF(box->identifier) | (is_remote ? CAN_REMOTE : 0)),
        .length = (uint8_t)BXCAN_LENGTH(box->length)};

    for (unsigned i = 0; i < 4; i++) {
        frame.data[i] = (uint8_t)(box->low >> 8U * i);
        frame.data[i + 4] = (uint8_t)(box->high >> 8U * i);
    }
    return frame;
}

static bool takes_part(void)
{
    return (msr & (BXCAN_MSR_INAK | BXCAN_MSR_SLAK)) == 0 && (esr & BXCAN_ESR_BUS_OFF) == 0 &&
           !can_model.is_absent;
}

/*
 * The lowest identifier wins, of equal ones the lowest mailbox; TXFP would make it the order of
 * requests.
 */
bool can_model_begin(struct can_frame *frame)
{
    unsigned first = NOBODY;

    move_modes();
    for (unsigned i = 0; i < 3 && takes_part(); i++) {
        if ((tsr & BXCAN_TSR_EMPTY(i)) == 0 &&
            (first == NOBODY ||
             BXCAN_ID_OF(mailbox[i].identifier) < BXCAN_ID_OF(mailbox[first].identifier)))
            first = i;
    }
    sending = first;
    if (first == NOBODY)
        return false;
    *frame = frame_of(&mailbox[first]);
    return true;
}

void can_model_end(bool acknowledged)
{
    const unsigned i = sending;

    sending = NOBODY;
    if (acknowledged || called_back[i])
        finish(i, acknowledged);
}

bool can_model_transfer(struct can_frame *frame)
{
    if (!can_model_begin(frame))
        return false;
    can_model_end(true);
    return true;
}

static bool matches(uint32_t half, uint32_t seen)
{
    return ((half ^ seen) & half >> 16 & 0xFFFFU) == 0;
}

/* Mode (mask), scale (16 bits) and FIFO (0) are all 0; active is FA1R. */
static bool is_accepted(uint32_t seen)
{
    for (unsigned i = 0; i < BXCAN_BANKS; i++) {
        if ((filter[filter_number(BXCAN_FA1R)] >> i & 1U) != 0 &&
            (matches(bank[(size_t)2 * i], seen) || matches(bank[(size_t)2 * i + 1], seen)))
            return true;
    }
    return false;
}

bool can_model_hear(const struct can_frame *frame)
{
    const uint32_t flags = can_model.extended_or_remote == 1   ? BXCAN_I_LONG
                           : can_model.extended_or_remote == 2 ? BXCAN_I_REMOTE
                                                               : 0;
    const uint32_t seen = (uint32_t)frame->id << 5 | (flags == BXCAN_I_REMOTE ? 0x10U : 0) |
                          (flags == BXCAN_I_LONG ? 8U : 0);
    struct mailbox *to;

    if (!takes_part() || (fmr & BXCAN_FMR_INIT) != 0 || !is_accepted(seen))
        return false;
    if (pending == FIFO)
        rf |= BXCAN_RF_OVERRUN;
    else
        pending++;
    to = &fifo[pending - 1];
    *to = (struct mailbox){.identifier = BXCAN_I_ID(frame->id) | flags, .length = frame->length};
    for (unsigned i = 0; i < 4; i++) {
        to->low |= (uint32_t)frame->data[i] << 8U * i;
        to->high |= (uint32_t)frame->data[i + 4] << 8U * i;
    }
    return true;
}

void can_model_lose_bus(void)
{
    esr |= BXCAN_ESR_BUS_OFF;
    sending = NOBODY;
    has_restarted = false;
}

/* Hears them only when it has been led through its start-up mode: ABOM is 0. */
void can_model_calm(void)
{
    move_modes();
    if (has_restarted && (msr & BXCAN_MSR_INAK) == 0)
        esr &= ~(BXCAN_ESR_BUS_OFF | 0xFFFF0000U);
}

void can_model_set_errors(unsigned last, unsigned sending_errors, unsigned receiving_errors)
{
    esr = (esr & 7U) | last << 4 | sending_errors << 16 | receiving_errors << 24;
}

bool can_model_asks_sent(void)
{
    return (ier & BXCAN_IER_TRANSMIT) != 0 && (tsr & 0x00010101U) != 0;
}

bool can_model_asks_received(void)
{
    return ((ier & BXCAN_IER_RECEIVE) != 0 && pending > 0) ||
           ((ier & BXCAN_IER_OVERRUN) != 0 && (rf & BXCAN_RF_OVERRUN) != 0);
}

unsigned can_model_waiting(void)
{
    unsigned count = 0;

    for (unsigned i = 0; i < 3; i++)
        count += (tsr & BXCAN_TSR_EMPTY(i)) == 0;
    return count;
}

void can_model_get_bit(struct can_model_bit *bit)
{
    bit->divider = (btr & 1023U) + 1U;
    bit->sampled = 1U + (btr >> 16 & 15U) + 1U;
    bit->quanta = bit->sampled + (btr >> 20 & 7U) + 1U;
    bit->jump = (btr >> 24 & 3U) + 1U;
}

const uint32_t can_model_clock_hz = 42000000;
const unsigned can_model_fifo = FIFO;
