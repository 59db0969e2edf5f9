/*
 * Crystal, PLL 1, buses, supply and wait states of an STM32H743, with the data sheet's limits
 * (DS12110, RM0433).
 */
#include "chip_model.h"
#include "clock_model.h"
#include "stm32h743/rcc.h"

#include <string.h>

#define BASE   0x58024400U
#define SIZE   0x400U
#define POWER  0x58024800U
#define STARTS 200U /* reads until an oscillator is ready */

#define INTERNAL_HZ 64000000U

struct clock_model clock_model;

static uint32_t word[SIZE / 4], power[SIZE / 4], acr;
static uint64_t crystal_at, pll_at; /* reads at which they were switched on */

static uint32_t *at(uint32_t address)
{
    return &word[(address - BASE) / 4];
}

static void reset(void)
{
    memset(word, 0, sizeof word);
    *at(RCC_CR) = RCC_CR_HSION;
    *at(RCC_PLLCKSELR) = 0x02020200U;
    *at(RCC_PLLCFGR) = 0x01FF0000U;
    *at(RCC_PLL1DIVR) = 0x01010280U;
    clock_model = (struct clock_model){.crystal_hz = 25000000, .pll_locks = true, .switches = true};
}

static bool crystal_is_ready(void)
{
    return (*at(RCC_CR) & RCC_CR_HSEON) != 0 && clock_model.crystal_hz != 0 &&
           chip_model_reads() - crystal_at > STARTS;
}

static bool is_from_crystal(void)
{
    return (*at(RCC_PLLCKSELR) & 3U) == RCC_PLLCKSELR_HSE;
}

static bool pll_is_ready(void)
{
    return (*at(RCC_CR) & RCC_CR_PLLON) != 0 && clock_model.pll_locks &&
           (!is_from_crystal() || crystal_is_ready()) && chip_model_reads() - pll_at > STARTS;
}

/* The range that is set is that of the input. */
static void check_input(uint32_t hz)
{
    const uint32_t range = *at(RCC_PLLCFGR) >> 2 & 3U;

    if (hz < 1000000U << range || hz > 2000000U << range || range == 0)
        chip_model_break("the PLL's input is not in the range that is set for the wide oscillator");
}

static uint32_t oscillator_hz(void)
{
    const uint32_t source = is_from_crystal() ? clock_model.crystal_hz : INTERNAL_HZ;
    const uint32_t m = *at(RCC_PLLCKSELR) >> 4 & 63U, n = (*at(RCC_PLL1DIVR) & 511U) + 1U;

    if (m == 0 || source % m != 0) {
        chip_model_break("the PLL's divider is not one");
        return 0;
    }
    check_input(source / m);
    if ((uint64_t)source / m * n > 836000000U || (uint64_t)source / m * n < 192000000U)
        chip_model_break("the PLL's oscillator is not 192 to 836 MHz");
    return source / m * n;
}

static bool runs_on_pll(void)
{
    return clock_model.switches && (*at(RCC_CFGR) & RCC_CFGR_SW_MASK) == RCC_CFGR_SW_PLL &&
           pll_is_ready();
}

uint32_t clock_model_core_hz(void)
{
    return runs_on_pll() ? oscillator_hz() / ((*at(RCC_PLL1DIVR) >> 9 & 127U) + 1U) : INTERNAL_HZ;
}

uint32_t clock_model_can_hz(void)
{
    const bool is_q = (*at(RCC_D2CCIP1R) & RCC_D2CCIP1R_FDCAN_MASK) == RCC_D2CCIP1R_FDCAN_PLL;

    if (!is_q || !pll_is_ready() || (*at(RCC_PLLCFGR) & 1U << 17) == 0)
        return 0;
    return oscillator_hz() / ((*at(RCC_PLL1DIVR) >> 16 & 127U) + 1U);
}

/* By 2, 4, 8, 16: of the peripheral buses, and beyond of the others. */
static uint32_t divided(uint32_t hz, uint32_t code, uint32_t begins)
{
    return code < begins ? hz : hz >> (code - begins + 1U);
}

static uint32_t buses_hz(void)
{
    return divided(clock_model_core_hz(), *at(RCC_D1CFGR) & 15U, 8);
}

uint32_t clock_model_bus1_hz(void)
{
    return divided(buses_hz(), *at(RCC_D2CFGR) >> 4 & 7U, 4);
}

static void check_buses(void)
{
    const uint32_t hz = buses_hz();

    if (hz > 200000000U)
        chip_model_break("the buses run faster than 200 MHz");
    if (clock_model_bus1_hz() > 100000000U ||
        divided(hz, *at(RCC_D1CFGR) >> 4 & 7U, 4) > 100000000U ||
        divided(hz, *at(RCC_D2CFGR) >> 8 & 7U, 4) > 100000000U ||
        divided(hz, *at(RCC_D3CFGR) >> 4 & 7U, 4) > 100000000U)
        chip_model_break("a peripheral bus runs faster than 100 MHz");
    if (hz > 70000000U * ((acr & 15U) + 1U))
        chip_model_break("too few wait states for the buses' clock");
    if (hz > 185000000U && (acr >> 4 & 3U) < 2U)
        chip_model_break("the delay of programming is too short for the buses' clock");
}

/* Limits of the data sheet, each time something changes. */
static void check(void)
{
    const uint32_t hz = clock_model_core_hz();

    if (hz > 400000000U)
        chip_model_break("the core runs faster than 400 MHz");
    if (hz > 200000000U && (power[0x18U / 4] & PWR_D3CR_VOS_MASK) != PWR_D3CR_VOS_1)
        chip_model_break("the regulator is not in the mode for more than 200 MHz");
    check_buses();
}

static uint32_t read(uint32_t offset)
{
    uint32_t value = word[offset / 4];

    if (clock_model.is_dead)
        return 0;
    if (offset == RCC_CR - BASE) {
        value &= ~(RCC_CR_HSERDY | RCC_CR_PLLRDY | RCC_CR_HSIRDY);
        value |= RCC_CR_HSIRDY | (crystal_is_ready() ? RCC_CR_HSERDY : 0) |
                 (pll_is_ready() ? RCC_CR_PLLRDY : 0);
    } else if (offset == RCC_CFGR - BASE) {
        value = (value & ~RCC_CFGR_SWS_MASK) | (runs_on_pll() ? RCC_CFGR_SWS_PLL : 0);
    }
    return value;
}

static bool is_of_pll(uint32_t offset)
{
    return offset == RCC_PLLCFGR - BASE || offset == RCC_PLLCKSELR - BASE ||
           offset == RCC_PLL1DIVR - BASE;
}

static void write(uint32_t offset, uint32_t value)
{
    const uint32_t before = word[offset / 4];

    if (clock_model.is_dead)
        return;
    if (is_of_pll(offset) && (*at(RCC_CR) & RCC_CR_PLLON) != 0)
        chip_model_break("the PLL is set while it is on");
    if (offset == RCC_CR - BASE) {
        if ((value & ~before & RCC_CR_HSEON) != 0)
            crystal_at = chip_model_reads();
        if ((value & ~before & RCC_CR_PLLON) != 0)
            pll_at = chip_model_reads();
        if ((value & RCC_CR_PLLON) == 0 && runs_on_pll())
            chip_model_break("the clock in use is switched off");
    }
    word[offset / 4] = value;
    check();
}

const struct chip_block chip_clocks = {BASE, SIZE, read, write, reset};

/* The regulator follows at once; its supply has to be chosen first, and once only. */
static uint32_t read_power(uint32_t offset)
{
    const bool is_chosen = (power[0xCU / 4] & PWR_CR3_OPEN) == 0;

    if (clock_model.is_dead)
        return 0;
    if (offset == PWR_CSR1 - POWER)
        return is_chosen ? PWR_CSR1_SUPPLIED : 0;
    return power[offset / 4] | (offset == PWR_D3CR - POWER ? PWR_D3CR_READY : 0);
}

static void write_power(uint32_t offset, uint32_t value)
{
    if (offset == PWR_CR3 - POWER && (power[offset / 4] & PWR_CR3_OPEN) == 0)
        chip_model_break("the supply is chosen twice");
    if (offset == PWR_D3CR - POWER && (power[0xCU / 4] & PWR_CR3_OPEN) != 0)
        chip_model_break("the regulator's mode is changed before its supply is chosen");
    power[offset / 4] = value;
}

static void reset_power(void)
{
    memset(power, 0, sizeof power);
    power[0xCU / 4] = PWR_CR3_LDO | PWR_CR3_OPEN;
    power[0x18U / 4] = 1U << 14;
    acr = 0x37U;
}

const struct chip_block chip_power = {POWER, SIZE, read_power, write_power, reset_power};

uint32_t clock_model_read_acr(void)
{
    return clock_model.is_dead ? 0 : acr;
}

void clock_model_write_acr(uint32_t value)
{
    acr = value;
    check();
}
