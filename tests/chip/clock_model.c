#include "clock_model.h"

#include "chip_model.h"
#include "stm32f405/rcc.h"

#include <string.h>

#define BASE   0x40023800U
#define SIZE   0x80U
#define STARTS 200U /* reads until an oscillator is ready */

#define INTERNAL_HZ 16000000U

struct clock_model clock_model;

static uint32_t word[SIZE / 4];
static uint64_t crystal_at, pll_at; /* reads at which they were switched on */
static uint32_t regulator, acr;

static uint32_t *at(uint32_t address)
{
    return &word[(address - BASE) / 4];
}

static void reset(void)
{
    memset(word, 0, sizeof word);
    *at(RCC_CR) = RCC_CR_HSION;
    *at(RCC_PLLCFGR) = 0x24003010U;
    clock_model = (struct clock_model){.crystal_hz = 8000000, .pll_locks = true, .switches = true};
}

static bool crystal_is_ready(void)
{
    return (*at(RCC_CR) & RCC_CR_HSEON) != 0 && clock_model.crystal_hz != 0 &&
           chip_model_reads() - crystal_at > STARTS;
}

static bool pll_is_ready(void)
{
    const bool crystal = (*at(RCC_PLLCFGR) & RCC_PLLCFGR_HSE) != 0;

    return (*at(RCC_CR) & RCC_CR_PLLON) != 0 && clock_model.pll_locks &&
           (!crystal || crystal_is_ready()) && chip_model_reads() - pll_at > STARTS;
}

static uint32_t pll_hz(void)
{
    const uint32_t config = *at(RCC_PLLCFGR);
    const uint32_t source = (config & RCC_PLLCFGR_HSE) != 0 ? clock_model.crystal_hz : INTERNAL_HZ;
    const uint32_t m = config & 63U, n = config >> 6 & 511U, p = 2 * ((config >> 16 & 3U) + 1);

    if (m < 2 || source / m < 1000000U || source / m > 2000000U)
        chip_model_break("the PLL's input is not 1 to 2 MHz");
    if ((uint64_t)source / m * n > 432000000U || (uint64_t)source / m * n < 100000000U)
        chip_model_break("the PLL's oscillator is not 100 to 432 MHz");
    return source / m * n / p;
}

static bool runs_on_pll(void)
{
    return clock_model.switches && (*at(RCC_CFGR) & RCC_CFGR_SW_MASK) == RCC_CFGR_SW_PLL &&
           pll_is_ready();
}

uint32_t clock_model_core_hz(void)
{
    return runs_on_pll() ? pll_hz() : INTERNAL_HZ;
}

static uint32_t divided(uint32_t hz, uint32_t code)
{
    return code < 4 ? hz : hz >> (code - 3U);
}

uint32_t clock_model_bus1_hz(void)
{
    return divided(clock_model_core_hz(), *at(RCC_CFGR) >> 10 & 7U);
}

/* Limits of the data sheet, each time something changes. */
static void check(void)
{
    const uint32_t hz = clock_model_core_hz();

    if (hz > 168000000U)
        chip_model_break("the core runs faster than 168 MHz");
    if (hz > 30000000U * ((acr & FLASH_ACR_LATENCY_MASK) + 1U))
        chip_model_break("too few wait states for the core's clock");
    if (hz > 144000000U && (regulator & PWR_CR_VOS) == 0)
        chip_model_break("the regulator is not in the mode for more than 144 MHz");
    if (clock_model_bus1_hz() > 42000000U)
        chip_model_break("APB1 runs faster than 42 MHz");
    if (divided(hz, *at(RCC_CFGR) >> 13 & 7U) > 84000000U)
        chip_model_break("APB2 runs faster than 84 MHz");
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

static void write(uint32_t offset, uint32_t value)
{
    const uint32_t before = word[offset / 4];

    if (clock_model.is_dead)
        return;
    if (offset == RCC_PLLCFGR - BASE && (*at(RCC_CR) & RCC_CR_PLLON) != 0)
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

static uint32_t read_power(uint32_t offset)
{
    return offset == 0 && !clock_model.is_dead ? regulator : 0;
}

static void write_power(uint32_t offset, uint32_t value)
{
    if (offset == 0 && (*at(RCC_APB1ENR) & RCC_APB1ENR_PWR) == 0)
        chip_model_break("the regulator is set without its clock");
    if (offset == 0)
        regulator = value;
}

static void reset_power(void)
{
    regulator = 0;
    acr = 0;
}

const struct chip_block chip_power = {0x40007000U, 0x400U, read_power, write_power, reset_power};

uint32_t clock_model_read_acr(void)
{
    return clock_model.is_dead ? 0 : acr;
}

void clock_model_write_acr(uint32_t value)
{
    acr = value;
    check();
}
