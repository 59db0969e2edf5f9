/* The clock of stm32/clock.h: 168 MHz (RM0090, chapter 7). */
#include "stm32/clock.h"

#include "stm32/chip.h"
#include "stm32f405/rcc.h"

#define MHZ 1000000U

/* Crystals that make exactly 168 MHz: whole MHz. */
#define CRYSTAL_MIN_HZ (4U * MHZ)
#define CRYSTAL_MAX_HZ (26U * MHZ)

#define INTERNAL_HZ (16U * MHZ)
#define PLL_HZ      (168U * MHZ)

/*
 * Waits, in reads of a register, of which the chip does at most some 3 million a second at 16 MHz:
 * a crystal starts in 2 ms and is given 100; the others take microseconds.
 */
#define CRYSTAL_READS 300000U
#define PLL_READS     30000U
#define SHORT_READS   10000U

/* Voltage 2.7 to 3.6 V: one wait state per 30 MHz. */
#define LATENCY_168 5U

static bool start_crystal(void)
{
    chip_change(RCC_CR, 0, RCC_CR_HSEON);
    if (chip_wait(RCC_CR, RCC_CR_HSERDY, RCC_CR_HSERDY, CRYSTAL_READS))
        return true;
    chip_change(RCC_CR, RCC_CR_HSEON, 0);
    return false;
}

/* Input 1 MHz = source / M, VCO 336 MHz, P = 2: 168 MHz, Q = 7: 48 MHz. */
static bool start_pll(uint32_t source_mhz, uint32_t source)
{
    chip_change(RCC_CR, RCC_CR_PLLON, 0);
    if (!chip_wait(RCC_CR, RCC_CR_PLLRDY, 0, SHORT_READS))
        return false;
    chip_change(RCC_PLLCFGR, RCC_PLLCFGR_WRITE_MASK,
                source_mhz | RCC_PLLCFGR_N(336U) | source | RCC_PLLCFGR_Q(7U));
    chip_change(RCC_CR, 0, RCC_CR_PLLON);
    if (chip_wait(RCC_CR, RCC_CR_PLLRDY, RCC_CR_PLLRDY, PLL_READS))
        return true;
    chip_change(RCC_CR, RCC_CR_PLLON, 0);
    return false;
}

/*
 * What must be so before the core runs at 168 MHz: regulator, wait states, buses within their
 * limits.
 */
static bool prepare_speed(void)
{
    chip_change(RCC_APB1ENR, 0, RCC_APB1ENR_PWR);
    chip_change(PWR_CR, 0, PWR_CR_VOS);
    chip_change(FLASH_ACR, FLASH_ACR_LATENCY_MASK,
                LATENCY_168 | FLASH_ACR_PREFETCH | FLASH_ACR_ICACHE | FLASH_ACR_DCACHE);
    if (!chip_wait(FLASH_ACR, FLASH_ACR_LATENCY_MASK, LATENCY_168, SHORT_READS))
        return false;
    chip_change(RCC_CFGR, RCC_CFGR_HPRE_MASK | RCC_CFGR_PPRE1_MASK | RCC_CFGR_PPRE2_MASK,
                RCC_CFGR_PPRE1_4 | RCC_CFGR_PPRE2_2);
    return true;
}

static bool switch_to_pll(void)
{
    if (!prepare_speed())
        return false;
    chip_change(RCC_CFGR, RCC_CFGR_SW_MASK, RCC_CFGR_SW_PLL);
    if (chip_wait(RCC_CFGR, RCC_CFGR_SWS_MASK, RCC_CFGR_SWS_PLL, SHORT_READS))
        return true;
    chip_change(RCC_CFGR, RCC_CFGR_SW_MASK, RCC_CFGR_SW_HSI);
    return false;
}

static bool crystal_fits(uint32_t crystal_hz)
{
    return crystal_hz >= CRYSTAL_MIN_HZ && crystal_hz <= CRYSTAL_MAX_HZ && crystal_hz % MHZ == 0;
}

static enum clock_source start_source(uint32_t crystal_hz)
{
    if (crystal_fits(crystal_hz) && start_crystal() &&
        start_pll(crystal_hz / MHZ, RCC_PLLCFGR_HSE) && switch_to_pll()) {
        /*
         * A crystal that stops later: the chip goes back to its own oscillator and raises an
         * interrupt.
         */
        chip_change(RCC_CR, 0, RCC_CR_CSSON);
        return CLOCK_CRYSTAL;
    }
    if (start_pll(INTERNAL_HZ / MHZ, 0) && switch_to_pll())
        return CLOCK_INTERNAL;
    return CLOCK_SLOW;
}

/* Timers run at twice the clock of a bus that is divided. */
static void set_fast(struct clock *clock)
{
    clock->core_hz = PLL_HZ;
    clock->bus1_hz = PLL_HZ / 4;
    clock->bus2_hz = PLL_HZ / 2;
    clock->timer1_hz = PLL_HZ / 2;
    clock->timer2_hz = PLL_HZ;
    clock->can_hz = clock->bus1_hz;
}

/* The buses undivided. */
static void set_slow(struct clock *clock)
{
    chip_change(RCC_CFGR, RCC_CFGR_HPRE_MASK | RCC_CFGR_PPRE1_MASK | RCC_CFGR_PPRE2_MASK, 0);
    clock->core_hz = INTERNAL_HZ;
    clock->bus1_hz = INTERNAL_HZ;
    clock->bus2_hz = INTERNAL_HZ;
    clock->timer1_hz = INTERNAL_HZ;
    clock->timer2_hz = INTERNAL_HZ;
    clock->can_hz = INTERNAL_HZ;
}

void takt_clock_start(struct clock *clock, uint32_t crystal_hz)
{
    clock->source = start_source(crystal_hz);
    if (clock->source == CLOCK_SLOW)
        set_slow(clock);
    else
        set_fast(clock);
}
