#include "timer_model.h"

#include "chip/peripherals.h"
#include "chip_model.h"

#include <string.h>

#define TIM1 0x40010000U
#define TIM2 0x40000000U
#define TIM3 0x40000400U
#define SIZE 0x400U

enum {
    CR1,
    CR2,
    SMCR,
    DIER,
    SR,
    EGR,
    CCMR1,
    CCMR2,
    CCER,
    CNT,
    PSC,
    ARR,
    RCR,
    CCR1,
    CCR2,
    CCR3,
    CCR4,
    BDTR,
    REGISTERS
};

#define ON         1U
#define UPDATE     1U
#define BREAK      (1U << 7)
#define MAIN_ON    (1U << 15)
#define TICK_READS 4U /* reads of its status from a tick to the next */
#define INPUT      1U
#define BOTH_EDGES (1U << 1 | 1U << 3) /* CCxP and CCxNP */

static uint32_t tim1[REGISTERS], tim2[REGISTERS], tim3[REGISTERS];
static uint32_t ports[2][10], levels[2];
static bool breaks, switched;
static unsigned waited;
static void (*on_tick)(void *context);
static void *tick_context;

static bool has_clock(uint32_t enable, uint32_t bit)
{
    return (chip_clocks.read(enable - chip_clocks.base) & bit) != 0;
}

static void put(uint32_t *timer, uint32_t offset, uint32_t value, bool clocked)
{
    if (!clocked)
        chip_model_break("a timer is written before its clock is on");
    if (offset / 4 < REGISTERS)
        timer[offset / 4] = value;
}

/* ---- TIM1 ---- */

static void take_break(void)
{
    if (!breaks || (tim1[BDTR] & 1U << 12) == 0)
        return;
    tim1[SR] |= BREAK;
    tim1[BDTR] &= ~MAIN_ON;
}

static void reset_1(void)
{
    memset(tim1, 0, sizeof tim1);
    breaks = false;
}

static uint32_t read_1(uint32_t offset)
{
    return tim1[offset / 4];
}

static void write_1(uint32_t offset, uint32_t value)
{
    const uint32_t status = tim1[SR];

    put(tim1, offset, value, has_clock(RCC_APB2ENR, RCC_APB2ENR_TIM1));
    if (offset / 4 == SR)
        tim1[SR] = status & value;
    if (tim1[CCR1] != 0 && tim1[CCR2] != 0)
        chip_model_break("both channels are high in a pulse");
    take_break();
}

/* PWM mode 1: high while the counter is below the width. */
static double part(unsigned channel)
{
    const uint32_t mode = tim1[CCMR1] >> 8U * channel & 0x7FU;
    const uint32_t width = tim1[CCR1 + channel], counts = tim1[ARR] + 1U;
    const bool is_on =
        (tim1[CCER] >> 4U * channel & 1U) != 0 && mode == 0x68U && (tim1[CR1] & ON) != 0;

    return is_on ? (width < counts ? width : counts) / (double)counts : 0;
}

double timer_model_get_torque(void)
{
    return (tim1[BDTR] & MAIN_ON) != 0 ? part(0) - part(1) : 0;
}

void timer_model_hold_break(bool low)
{
    breaks = low;
    take_break();
}

/* ---- TIM2 ---- */

static void reset_2(void)
{
    memset(tim2, 0, sizeof tim2);
    on_tick = NULL;
    waited = 0;
}

static void tick(void)
{
    tim2[SR] |= UPDATE;
    waited = 0;
    if (on_tick != NULL)
        on_tick(tick_context);
}

static uint32_t read_2(uint32_t offset)
{
    if (offset / 4 == SR && (tim2[CR1] & ON) != 0 && tim2[SR] == 0 && ++waited == TICK_READS)
        tick();
    return tim2[offset / 4];
}

static void write_2(uint32_t offset, uint32_t value)
{
    const uint32_t status = tim2[SR];

    put(tim2, offset, value, has_clock(RCC_APB1ENR, RCC_APB1ENR_TIM2));
    if (offset / 4 == SR)
        tim2[SR] = status & value;
}

void timer_model_set_tick(void (*call)(void *context), void *context)
{
    on_tick = call;
    tick_context = context;
}

void timer_model_hurry(void)
{
    tick();
}

/* ---- TIM3 ---- */

static void reset_3(void)
{
    memset(tim3, 0, sizeof tim3);
    switched = false;
}

static uint32_t read_3(uint32_t offset)
{
    if (offset / 4 == CCR3)
        tim3[SR] &= ~(1U << 3);
    if (offset / 4 == CCR4)
        tim3[SR] &= ~(1U << 4);
    return tim3[offset / 4];
}

static void write_3(uint32_t offset, uint32_t value)
{
    const uint32_t status = tim3[SR];

    put(tim3, offset, value, has_clock(RCC_APB1ENR, RCC_APB1ENR_TIM3));
    if (offset / 4 == SR)
        tim3[SR] = status & value;
}

void timer_model_turn(int32_t counts)
{
    const bool counts_both = (tim3[SMCR] & 7U) == 3U && (tim3[CCMR1] & 0x303U) == 0x101U;

    if (counts_both && (tim3[CR1] & ON) != 0)
        tim3[CNT] = (tim3[CNT] + (uint32_t)counts) & tim3[ARR];
}

/* Captures on channel 3 or 4, where it is an input and looks at this edge. */
static void capture(unsigned channel, bool rises)
{
    const unsigned place = channel - 3U;
    const uint32_t edges = tim3[CCER] >> (8U + 4U * place);
    const bool falls_too = (edges & BOTH_EDGES) == BOTH_EDGES;

    if ((tim3[CCMR2] >> 8U * place & 3U) != INPUT || (edges & 1U) == 0 || (!rises && !falls_too))
        return;
    tim3[CCR3 + place] = tim3[CNT];
    tim3[SR] |= 1U << channel;
}

void timer_model_pulse_index(void)
{
    capture(3, true);
    capture(3, false);
}

void timer_model_switch(bool high)
{
    if (high != switched)
        capture(4, high);
    switched = high;
}

/* ---- ports B and C ---- */

static void reset_ports(void)
{
    memset(ports, 0, sizeof ports);
    levels[0] = levels[1] = 0;
}

static uint32_t read_port(unsigned port, uint32_t offset)
{
    return offset == 0x10U ? levels[port] : ports[port][offset / 4];
}

static uint32_t read_b(uint32_t offset)
{
    return read_port(0, offset);
}

static uint32_t read_c(uint32_t offset)
{
    return read_port(1, offset);
}

/* BSRR: the lower half sets pins of ODR, the upper one clears them. */
static void write_port(unsigned port, uint32_t offset, uint32_t value)
{
    uint32_t *levels_out = &ports[port][5];

    if (offset == 0x18U)
        *levels_out = (*levels_out & ~(value >> 16)) | (value & 0xFFFFU);
    else
        ports[port][offset / 4] = value;
}

static void write_b(uint32_t offset, uint32_t value)
{
    write_port(0, offset, value);
}

static void write_c(uint32_t offset, uint32_t value)
{
    write_port(1, offset, value);
}

bool timer_model_pin_is_high(unsigned number)
{
    return (ports[1][5] >> number & 1U) != 0;
}

void timer_model_set_pin(char port, unsigned number, bool high)
{
    uint32_t *level = &levels[port - 'B'];

    *level = high ? *level | 1U << number : *level & ~(1U << number);
}

const struct chip_block chip_tim1 = {TIM1, SIZE, read_1, write_1, reset_1};
const struct chip_block chip_tim2 = {TIM2, SIZE, read_2, write_2, reset_2};
const struct chip_block chip_tim3 = {TIM3, SIZE, read_3, write_3, reset_3};
const struct chip_block chip_gpio_b = {GPIO_BASE + 0x400U, 0x400U, read_b, write_b, reset_ports};
const struct chip_block chip_gpio_c = {GPIO_BASE + 0x800U, 0x400U, read_c, write_c, reset_ports};
