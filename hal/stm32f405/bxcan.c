/* bxCAN (RM0090, chapter 32) behind stm32/can_hardware.h. */
#include "stm32/can_hardware.h"
#include "stm32/chip.h"
#include "stm32f405/bxcan_registers.h"
#include "stm32f405/rcc.h"

#include <string.h>

/*
 * Reads of a register; at 168 MHz some 2 ms. The controller answers within a few bits, the bus when
 * it is idle.
 */
#define ANSWER_READS 50000U

#define QUANTA_MIN 8U
#define QUANTA_MAX 25U
#define TS2_MAX    8U
#define SJW_MAX    4U
#define BRP_MAX    1024U

static uint32_t read(uint32_t offset)
{
    return takt_chip_read(BXCAN_CAN1 + offset);
}

static void write(uint32_t offset, uint32_t value)
{
    takt_chip_write(BXCAN_CAN1 + offset, value);
}

/* ---- bit timing ---- */

/* Thousandths of a bit between the sample point of quanta with this many behind it and 7/8. */
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

/*
 * The bit timing register for a rate: sampled as near to 7/8 of a bit as can be. 0: no division of
 * the clock gives it.
 */
static uint32_t timing_for(uint32_t clock_hz, uint32_t bitrate)
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

uint32_t takt_can_hardware_find_impossible(uint32_t clock_hz, const struct can_rates *rates)
{
    if (rates->data != 0)
        return rates->data;
    return timing_for(clock_hz, rates->nominal) != 0 ? 0 : rates->nominal;
}

/* ---- start ---- */

static void accept_everything(void)
{
    write(BXCAN_FR1(0), BXCAN_FILTER(0, 0));
    write(BXCAN_FR2(0), BXCAN_FILTER(0, 0));
    write(BXCAN_FA1R, 1);
}

/* Two nodes a bank; the last may be there twice. */
static void accept_nodes(const struct can_config *config)
{
    for (unsigned i = 0; i < config->nodes; i += 2) {
        const unsigned second = i + 1 < config->nodes ? i + 1 : i;

        write(BXCAN_FR1(i / 2), BXCAN_FILTER(config->node[i], 0x7F));
        write(BXCAN_FR2(i / 2), BXCAN_FILTER(config->node[second], 0x7F));
    }
    write(BXCAN_FA1R, (1U << (config->nodes + 1) / 2) - 1U);
}

/* All banks: 16 bits, masks, first FIFO. */
static void set_filters(const struct can_config *config)
{
    chip_change(BXCAN_CAN1 + BXCAN_FMR, 0, BXCAN_FMR_INIT);
    write(BXCAN_FA1R, 0);
    write(BXCAN_FM1R, 0);
    write(BXCAN_FS1R, 0);
    write(BXCAN_FFA1R, 0);
    if (config->nodes == 0)
        accept_everything();
    else
        accept_nodes(config);
    chip_change(BXCAN_CAN1 + BXCAN_FMR, BXCAN_FMR_INIT, 0);
}

/* By priority, not in the order of requests; repeats until acknowledged; bus-off is ours to end. */
static bool enter_start(void)
{
    write(BXCAN_MCR, BXCAN_MCR_INRQ);
    return chip_wait(BXCAN_CAN1 + BXCAN_MSR, BXCAN_MSR_INAK | BXCAN_MSR_SLAK, BXCAN_MSR_INAK,
                     ANSWER_READS);
}

bool takt_can_hardware_open(const struct can_config *config)
{
    chip_change(RCC_APB1ENR, 0, RCC_APB1ENR_CAN1);
    if (!enter_start())
        return false;
    write(BXCAN_BTR, timing_for(config->clock_hz, config->rates.nominal));
    set_filters(config);
    write(BXCAN_IER, BXCAN_IER_TRANSMIT | BXCAN_IER_RECEIVE | BXCAN_IER_OVERRUN);
    return true;
}

/* Leaves the start-up mode: the controller takes part when it has heard 11 recessive bits. */
bool takt_can_hardware_join(void)
{
    chip_change(BXCAN_CAN1 + BXCAN_MCR, BXCAN_MCR_INRQ, 0);
    return chip_wait(BXCAN_CAN1 + BXCAN_MSR, BXCAN_MSR_INAK, 0, ANSWER_READS);
}

bool takt_can_hardware_takes_part(void)
{
    return (read(BXCAN_MSR) & BXCAN_MSR_INAK) == 0 && !takt_can_hardware_is_off();
}

bool takt_can_hardware_is_off(void)
{
    return (read(BXCAN_ESR) & BXCAN_ESR_BUS_OFF) != 0;
}

/* It has to be led through its start-up mode; joining then counts the recessive bits. */
void takt_can_hardware_leave(void)
{
    write(BXCAN_TSR, BXCAN_TSR_ABRQ(0) | BXCAN_TSR_ABRQ(1) | BXCAN_TSR_ABRQ(2));
    chip_change(BXCAN_CAN1 + BXCAN_MCR, 0, BXCAN_MCR_INRQ);
}

bool takt_can_hardware_rejoin(void)
{
    if ((read(BXCAN_MSR) & BXCAN_MSR_INAK) == 0)
        return false;
    chip_change(BXCAN_CAN1 + BXCAN_MCR, BXCAN_MCR_INRQ, 0);
    return true;
}

/* ---- sending ---- */

static uint32_t word_of(const uint8_t *byte)
{
    return (uint32_t)byte[0] | (uint32_t)byte[1] << 8 | (uint32_t)byte[2] << 16 |
           (uint32_t)byte[3] << 24;
}

void takt_can_hardware_load(unsigned i, const struct can_frame *frame)
{
    write(BXCAN_TDT(i), frame->length);
    write(BXCAN_TDL(i), word_of(frame->data));
    write(BXCAN_TDH(i), word_of(frame->data + 4));
    write(BXCAN_TI(i), BXCAN_I_ID(frame->id & CAN_ID_MASK) | BXCAN_TI_TXRQ |
                           (can_is_remote(frame) ? BXCAN_I_REMOTE : 0));
}

void takt_can_hardware_take_back(unsigned i)
{
    write(BXCAN_TSR, BXCAN_TSR_ABRQ(i));
}

unsigned takt_can_hardware_take_done(unsigned *sent)
{
    const uint32_t status = read(BXCAN_TSR);
    unsigned done = 0;

    *sent = 0;
    for (unsigned i = 0; i < CAN_MAILBOXES; i++) {
        if ((status & BXCAN_TSR_RQCP(i)) == 0)
            continue;
        write(BXCAN_TSR, BXCAN_TSR_RQCP(i));
        done |= 1U << i;
        *sent |= (unsigned)((status & BXCAN_TSR_TXOK(i)) != 0) << i;
    }
    return done;
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
static bool read_head(struct can_frame *frame)
{
    const uint32_t identifier = read(BXCAN_RI);
    const uint32_t length = BXCAN_LENGTH(read(BXCAN_RDT));

    if ((identifier & (BXCAN_I_LONG | BXCAN_I_REMOTE)) != 0)
        return false;
    *frame = (struct can_frame){.id = (uint16_t)BXCAN_ID_OF(identifier)};
    frame->length = (uint8_t)(length < CAN_CLASSIC_MAX ? length : CAN_CLASSIC_MAX);
    unpack(frame, read(BXCAN_RDL), read(BXCAN_RDH));
    memset(frame->data + frame->length, 0, (size_t)CAN_CLASSIC_MAX - frame->length);
    return true;
}

enum can_heard takt_can_hardware_hear(struct can_frame *frame)
{
    bool good;

    if ((read(BXCAN_RF0R) & BXCAN_RF_PENDING_MASK) == 0)
        return CAN_HEARD_NOTHING;
    good = read_head(frame);
    write(BXCAN_RF0R, BXCAN_RF_RELEASE);
    return chip_wait(BXCAN_CAN1 + BXCAN_RF0R, BXCAN_RF_RELEASE, 0, ANSWER_READS) && good
               ? CAN_HEARD_FRAME
               : CAN_HEARD_OTHER;
}

bool takt_can_hardware_take_overrun(void)
{
    const bool any = (read(BXCAN_RF0R) & BXCAN_RF_OVERRUN) != 0;

    if (any)
        write(BXCAN_RF0R, BXCAN_RF_OVERRUN);
    return any;
}

/* ---- errors ---- */

/* The code stays until it is overwritten with the one the controller never sets. */
unsigned takt_can_hardware_take_error(void)
{
    const unsigned code = BXCAN_ESR_LAST(read(BXCAN_ESR));

    if (code == BXCAN_ESR_LAST_UNUSED || code == 0)
        return 0;
    write(BXCAN_ESR, BXCAN_ESR_LAST_UNUSED << 4);
    return code;
}

void takt_can_hardware_get_errors(unsigned *sending, unsigned *receiving)
{
    const uint32_t status = read(BXCAN_ESR);

    *sending = BXCAN_ESR_SENT(status);
    *receiving = BXCAN_ESR_HEARD(status);
}
