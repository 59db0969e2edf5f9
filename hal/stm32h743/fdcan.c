/*
 * FDCAN (RM0433, chapter 56) behind stm32/can_hardware.h: classical CAN, and CAN FD whose data go
 * at a rate of their own.
 */
#include "stm32/can_hardware.h"
#include "stm32/chip.h"
#include "stm32h743/fdcan_registers.h"
#include "stm32h743/peripherals.h"

#include <string.h>

/*
 * Reads of a register, some 2 ms. The controller answers within a few bits, the bus when it is
 * idle.
 */
#define ANSWER_READS 25000U

/* The message memory, in words: filters, first FIFO, mailboxes. */
#define FIFO         32U
#define FILTERS_AT   0U
#define FIFO_AT      (FILTERS_AT + CAN_NODES_MAX)
#define MAILBOXES_AT (FIFO_AT + FIFO * FDCAN_ELEMENT_WORDS)

#define ALL_MAILBOXES ((1U << CAN_MAILBOXES) - 1U)

static uint32_t read(uint32_t offset)
{
    return takt_chip_read(FDCAN_1 + offset);
}

static void write(uint32_t offset, uint32_t value)
{
    takt_chip_write(FDCAN_1 + offset, value);
}

static uint32_t word_address(uint32_t word)
{
    return FDCAN_MEMORY + 4U * word;
}

/* ---- bit timing ---- */

/* A bit: 1 quantum, before, the sample, behind. */
struct bit {
    uint32_t before, behind;
};

/* What the registers can hold. */
struct limits {
    uint32_t before, behind, divider;
};

static const struct limits nominal_limits = {256, 128, 512}, data_limits = {32, 16, 32};

#define QUANTA_MIN 8U

/*
 * A transceiver's delay is measured, and compensated, only for quanta of up to two clocks (ISO
 * 11898-1, 11.3.3).
 */
#define DELAY_DIVIDER_MAX 2U
#define DELAY_OFFSET_MAX  127U

/*
 * Thousandths of a bit before the sample. All nodes must sample CAN FD at the same point, since the
 * rate changes there: where SocketCAN has it. Classical CAN as CiA 301 asks for it.
 */
static uint32_t sample_of(uint32_t rate, bool is_fd)
{
    if (!is_fd || rate <= 500000U)
        return 875;
    return rate <= 800000U ? 800 : 750;
}

static bool divide(uint32_t clock_hz, uint32_t rate, uint32_t divider, bool is_fd,
                   const struct limits *limits, struct bit *bit)
{
    const uint64_t step = (uint64_t)rate * divider;
    uint32_t quanta;

    if (step == 0 || clock_hz % step != 0 || divider > limits->divider)
        return false;
    quanta = (uint32_t)(clock_hz / step);
    bit->behind = (quanta * (1000U - sample_of(rate, is_fd)) + 500U) / 1000U;
    bit->before = quanta - 1U - bit->behind;
    return quanta >= QUANTA_MIN && bit->before <= limits->before && bit->behind <= limits->behind;
}

/*
 * The same quanta for both rates, as short as can be (CiA 601-3). 0: no division of the clock gives
 * them.
 */
static uint32_t divider_for(uint32_t clock_hz, const struct can_rates *rates, struct bit *nominal,
                            struct bit *data)
{
    const bool is_fd = rates->data != 0;

    for (uint32_t divider = 1; divider <= nominal_limits.divider; divider++) {
        if (divide(clock_hz, rates->nominal, divider, is_fd, &nominal_limits, nominal) &&
            (!is_fd || divide(clock_hz, rates->data, divider, true, &data_limits, data)))
            return divider;
    }
    return 0;
}

uint32_t takt_can_hardware_find_impossible(uint32_t clock_hz, const struct can_rates *rates)
{
    const struct can_rates classical = {rates->nominal, 0};
    struct bit nominal, data;

    if (divider_for(clock_hz, rates, &nominal, &data) != 0)
        return 0;
    return divider_for(clock_hz, &classical, &nominal, &data) != 0 ? rates->data : rates->nominal;
}

/*
 * The second sample of what the node itself sends: as far behind the measured delay as the first is
 * in a bit.
 */
static void set_data_bit(uint32_t divider, const struct bit *bit)
{
    const uint32_t offset = divider * (1U + bit->before);
    const bool measures = divider <= DELAY_DIVIDER_MAX && offset <= DELAY_OFFSET_MAX;

    write(FDCAN_DBTP, FDCAN_DBTP_BRP(divider) | FDCAN_DBTP_TS1(bit->before) |
                          FDCAN_DBTP_TS2(bit->behind) | FDCAN_DBTP_SJW(bit->behind) |
                          (measures ? FDCAN_DBTP_TDC : 0));
    write(FDCAN_TDCR, measures ? FDCAN_TDCR_OFFSET(offset) : 0);
}

static void set_bits(const struct can_config *config)
{
    struct bit nominal, data;
    const uint32_t divider = divider_for(config->clock_hz, &config->rates, &nominal, &data);

    write(FDCAN_NBTP, FDCAN_NBTP_BRP(divider) | FDCAN_NBTP_TS1(nominal.before) |
                          FDCAN_NBTP_TS2(nominal.behind) | FDCAN_NBTP_SJW(nominal.behind));
    if (config->rates.data != 0)
        set_data_bit(divider, &data);
}

/* ---- start ---- */

static bool is_starting(void)
{
    return (read(FDCAN_CCCR) & FDCAN_CCCR_INIT) != 0;
}

/* What can be set only now, and empties FIFO and mailboxes. */
static bool enter_start(uint32_t modes)
{
    write(FDCAN_CCCR, FDCAN_CCCR_INIT);
    if (!chip_wait(FDCAN_1 + FDCAN_CCCR, FDCAN_CCCR_INIT, FDCAN_CCCR_INIT, ANSWER_READS))
        return false;
    write(FDCAN_CCCR, FDCAN_CCCR_INIT | FDCAN_CCCR_CCE);
    write(FDCAN_CCCR, FDCAN_CCCR_INIT | FDCAN_CCCR_CCE | modes);
    takt_chip_write(FDCAN_CCFG, FDCAN_CCFG_BYPASS);
    return true;
}

static void set_filters(const struct can_config *config)
{
    for (unsigned i = 0; i < config->nodes; i++)
        takt_chip_write(word_address(FILTERS_AT + i), FDCAN_FILTER(config->node[i], 0x7FU));
    write(FDCAN_GFC, config->nodes == 0 ? FDCAN_GFC_ANY : FDCAN_GFC_NAMED_ONLY);
    write(FDCAN_SIDFC, FDCAN_SIDFC_LIST(FILTERS_AT, config->nodes));
    write(FDCAN_XIDFC, 0);
}

static void set_memory(void)
{
    write(FDCAN_RXF0C, FDCAN_RXF0C_LIST(FIFO_AT, FIFO));
    write(FDCAN_RXESC, FDCAN_ESC_64_BYTES);
    write(FDCAN_TXBC, FDCAN_TXBC_LIST(MAILBOXES_AT, CAN_MAILBOXES));
    write(FDCAN_TXESC, FDCAN_ESC_64_BYTES);
}

/* What has been sent on the first line, what has come on the second. */
static void set_interrupts(void)
{
    write(FDCAN_IR, UINT32_MAX);
    write(FDCAN_IE, FDCAN_IR_RECEIVED | FDCAN_IR_LOST | FDCAN_IR_SENT | FDCAN_IR_CANCELLED);
    write(FDCAN_ILS, FDCAN_IR_RECEIVED | FDCAN_IR_LOST);
    write(FDCAN_TXBTIE, ALL_MAILBOXES);
    write(FDCAN_TXBCIE, ALL_MAILBOXES);
    write(FDCAN_ILE, FDCAN_ILE_BOTH);
}

bool takt_can_hardware_open(const struct can_config *config)
{
    chip_change(RCC_APB1HENR, 0, RCC_APB1HENR_FDCAN);
    if (!enter_start(config->rates.data != 0 ? FDCAN_CCCR_FDOE | FDCAN_CCCR_BRSE : 0))
        return false;
    set_bits(config);
    set_filters(config);
    set_memory();
    set_interrupts();
    return true;
}

bool takt_can_hardware_takes_part(void)
{
    const uint32_t status = read(FDCAN_PSR);

    return !is_starting() && (status & FDCAN_PSR_BUS_OFF) == 0 && FDCAN_PSR_ACTIVITY(status) != 0;
}

/* It is in step when it has heard 11 recessive bits. */
bool takt_can_hardware_join(void)
{
    bool good = false;

    chip_change(FDCAN_1 + FDCAN_CCCR, FDCAN_CCCR_INIT | FDCAN_CCCR_CCE, 0);
    for (uint32_t i = 0; i < ANSWER_READS && !good; i++)
        good = takt_can_hardware_takes_part();
    return good;
}

bool takt_can_hardware_is_off(void)
{
    return (read(FDCAN_PSR) & FDCAN_PSR_BUS_OFF) != 0;
}

/*
 * At bus-off the controller goes to its start-up mode by itself; allowing changes there empties the
 * mailboxes.
 */
void takt_can_hardware_leave(void)
{
    chip_change(FDCAN_1 + FDCAN_CCCR, 0, FDCAN_CCCR_INIT);
    chip_change(FDCAN_1 + FDCAN_CCCR, 0, FDCAN_CCCR_CCE);
}

bool takt_can_hardware_rejoin(void)
{
    if (!is_starting())
        return false;
    chip_change(FDCAN_1 + FDCAN_CCCR, FDCAN_CCCR_INIT | FDCAN_CCCR_CCE, 0);
    return true;
}

/* ---- frames ---- */

/* 9 ... 15 stand for 12, 16, 20, 24, 32, 48, 64 bytes (ISO 11898-1, table 5). */
static const uint8_t lengths[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};

static uint32_t code_of(uint8_t length)
{
    uint32_t code = 0;

    while (lengths[code] < length)
        code++;
    return code;
}

static uint32_t word_of(const uint8_t *byte)
{
    return (uint32_t)byte[0] | (uint32_t)byte[1] << 8 | (uint32_t)byte[2] << 16 |
           (uint32_t)byte[3] << 24;
}

static uint32_t control_of(const struct can_frame *frame)
{
    const bool is_fd = (read(FDCAN_CCCR) & FDCAN_CCCR_FDOE) != 0 && !can_is_remote(frame);

    return FDCAN_E1_DLC(code_of(frame->length)) | (is_fd ? FDCAN_E1_FD | FDCAN_E1_FAST : 0);
}

void takt_can_hardware_load(unsigned i, const struct can_frame *frame)
{
    const uint32_t at = word_address(MAILBOXES_AT + i * FDCAN_ELEMENT_WORDS);

    takt_chip_write(at, FDCAN_E0_ID(frame->id & CAN_ID_MASK) |
                            (can_is_remote(frame) ? FDCAN_E0_REMOTE : 0));
    takt_chip_write(at + 4U, control_of(frame));
    for (unsigned byte = 0; byte < can_data_length(frame); byte += 4)
        takt_chip_write(at + 8U + byte, word_of(frame->data + byte));
    write(FDCAN_TXBAR, 1U << i);
}

void takt_can_hardware_take_back(unsigned i)
{
    write(FDCAN_TXBCR, 1U << i);
}

/* What ended before the flags are cleared is seen here; what ends later raises them again. */
unsigned takt_can_hardware_take_done(unsigned *sent)
{
    uint32_t done;

    write(FDCAN_IR, FDCAN_IR_SENT | FDCAN_IR_CANCELLED);
    done = ~read(FDCAN_TXBRP) & ALL_MAILBOXES;
    *sent = read(FDCAN_TXBTO) & done;
    return done & (*sent | read(FDCAN_TXBCF));
}

/* Bytes behind the frame's length are 0. */
static void read_data(struct can_frame *frame, uint32_t at)
{
    for (unsigned i = 0; i < frame->length; i += 4) {
        const uint32_t word = takt_chip_read(at + i);

        for (unsigned byte = i; byte < i + 4 && byte < frame->length; byte++)
            frame->data[byte] = (uint8_t)(word >> 8U * (byte - i));
    }
}

static bool read_element(struct can_frame *frame, uint32_t at)
{
    const uint32_t identifier = takt_chip_read(at), control = takt_chip_read(at + 4U);
    const uint8_t length = lengths[FDCAN_E1_DLC_OF(control)];

    if ((identifier & (FDCAN_E0_LONG | FDCAN_E0_REMOTE)) != 0)
        return false;
    *frame = (struct can_frame){.id = (uint16_t)FDCAN_E0_ID_OF(identifier), .length = length};
    if ((control & FDCAN_E1_FD) == 0 && length > CAN_CLASSIC_MAX)
        frame->length = CAN_CLASSIC_MAX;
    read_data(frame, at + 8U);
    return true;
}

enum can_heard takt_can_hardware_hear(struct can_frame *frame)
{
    uint32_t status, first;
    bool good;

    write(FDCAN_IR, FDCAN_IR_RECEIVED);
    status = read(FDCAN_RXF0S);
    if (FDCAN_RXF0S_LEVEL(status) == 0)
        return CAN_HEARD_NOTHING;
    first = FDCAN_RXF0S_FIRST(status);
    good = read_element(frame, word_address(FIFO_AT + first * FDCAN_ELEMENT_WORDS));
    write(FDCAN_RXF0A, first);
    return good ? CAN_HEARD_FRAME : CAN_HEARD_OTHER;
}

bool takt_can_hardware_take_overrun(void)
{
    const bool any = (read(FDCAN_IR) & FDCAN_IR_LOST) != 0;

    if (any)
        write(FDCAN_IR, FDCAN_IR_LOST);
    return any;
}

/* ---- errors ---- */

/* Reading the status forgets it. */
unsigned takt_can_hardware_take_error(void)
{
    const uint32_t status = read(FDCAN_PSR);
    const unsigned last = FDCAN_PSR_LAST(status), data = FDCAN_PSR_LAST_DATA(status);

    if (data != 0 && data != FDCAN_PSR_LAST_UNCHANGED)
        return data;
    return last == FDCAN_PSR_LAST_UNCHANGED ? 0 : last;
}

void takt_can_hardware_get_errors(unsigned *sending, unsigned *receiving)
{
    const uint32_t errors = read(FDCAN_ECR);

    *sending = FDCAN_ECR_SENT(errors);
    *receiving = FDCAN_ECR_HEARD(errors);
}
