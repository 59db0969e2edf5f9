/*
 * The clock of stm32/clock.h: 400 MHz, buses 200 MHz, peripherals 100 MHz, FDCAN 80 MHz (RM0433,
 * chapter 8).
 */
#include "stm32/clock.h"

#include "stm32/chip.h"
#include "stm32h743/rcc.h"

#define MHZ 1000000U

#define CRYSTAL_MIN_HZ (4U * MHZ)
#define CRYSTAL_MAX_HZ (48U * MHZ)

#define INTERNAL_HZ (64U * MHZ)
#define VCO_MHZ     800U
#define PLL_HZ      (400U * MHZ)
#define CAN_HZ      (80U * MHZ)

/*
 * Waits, in reads of a register, of which the chip does at most some 10 million a second at 64 MHz:
 * a crystal starts in 2 ms and is given 100; the others take microseconds.
 */
#define CRYSTAL_READS 1000000U
#define PLL_READS     100000U
#define SHORT_READS   30000U

/*
 * Two wait states and the longest delay of programming: up to 210 MHz in this mode of the regulator
 * (RM0433, table 17).
 */
#define FLASH_ACR_200_MHZ (2U | 2U << 4)

static bool start_crystal(void)
{
    chip_change(RCC_CR, 0, RCC_CR_HSEON);
    if (chip_wait(RCC_CR, RCC_CR_HSERDY, RCC_CR_HSERDY, CRYSTAL_READS))
        return true;
    chip_change(RCC_CR, RCC_CR_HSEON, 0);
    return false;
}

/*
 * The PLL's input: 2 MHz of an even source, 5 of one that 5 divides; both divide 800. 0: there is
 * none.
 */
static uint32_t input_mhz(uint32_t source_mhz)
{
    if (source_mhz % 2U == 0)
        return 2;
    return source_mhz % 5U == 0 ? 5 : 0;
}

/* Oscillator 800 MHz = N times the input; P = 2: 400 MHz, Q = 10: 80 MHz. */
static bool start_pll(uint32_t source_mhz, uint32_t source)
{
    const uint32_t input = input_mhz(source_mhz);

    chip_change(RCC_CR, RCC_CR_PLLON, 0);
    if (!chip_wait(RCC_CR, RCC_CR_PLLRDY, 0, SHORT_READS))
        return false;
    chip_change(RCC_PLLCKSELR, RCC_PLLCKSELR_MASK, source | RCC_PLLCKSELR_DIVM(source_mhz / input));
    chip_change(RCC_PLLCFGR, RCC_PLLCFGR_MASK,
                RCC_PLLCFGR_P_Q | (input < 4 ? RCC_PLLCFGR_2_4_MHZ : RCC_PLLCFGR_4_8_MHZ));
    takt_chip_write(RCC_PLL1DIVR, RCC_PLL1DIVR_N(VCO_MHZ / input) | RCC_PLL1DIVR_P(2U) |
                                      RCC_PLL1DIVR_Q(10U) | RCC_PLL1DIVR_R(2U));
    chip_change(RCC_CR, 0, RCC_CR_PLLON);
    if (chip_wait(RCC_CR, RCC_CR_PLLRDY, RCC_CR_PLLRDY, PLL_READS))
        return true;
    chip_change(RCC_CR, RCC_CR_PLLON, 0);
    return false;
}

/*
 * Supplied by the chip's own regulator, which has to be said once after power-on, before its mode
 * may change.
 */
static bool prepare_power(void)
{
    if ((takt_chip_read(PWR_CR3) & PWR_CR3_OPEN) != 0)
        chip_change(PWR_CR3, PWR_CR3_OPEN | PWR_CR3_BYPASS, PWR_CR3_LDO);
    if (!chip_wait(PWR_CSR1, PWR_CSR1_SUPPLIED, PWR_CSR1_SUPPLIED, SHORT_READS))
        return false;
    chip_change(PWR_D3CR, PWR_D3CR_VOS_MASK, PWR_D3CR_VOS_1);
    return chip_wait(PWR_D3CR, PWR_D3CR_READY, PWR_D3CR_READY, SHORT_READS);
}

/*
 * What must be so before the core runs at 400 MHz: regulator, wait states, buses within their
 * limits.
 */
static bool prepare_speed(void)
{
    if (!prepare_power())
        return false;
    chip_change(FLASH_ACR, FLASH_ACR_MASK, FLASH_ACR_200_MHZ);
    if (!chip_wait(FLASH_ACR, FLASH_ACR_MASK, FLASH_ACR_200_MHZ, SHORT_READS))
        return false;
    chip_change(RCC_D1CFGR, RCC_D1CFGR_MASK, RCC_D1CFGR_HPRE_2 | RCC_D1CFGR_D1PPRE_2);
    chip_change(RCC_D2CFGR, RCC_D2CFGR_MASK, RCC_D2CFGR_PPRE1_2 | RCC_D2CFGR_PPRE2_2);
    chip_change(RCC_D3CFGR, RCC_D3CFGR_MASK, RCC_D3CFGR_PPRE_2);
    return true;
}

static bool switch_to_pll(void)
{
    if (!prepare_speed())
        return false;
    chip_change(RCC_CFGR, RCC_CFGR_SW_MASK, RCC_CFGR_SW_PLL);
    if (!chip_wait(RCC_CFGR, RCC_CFGR_SWS_MASK, RCC_CFGR_SWS_PLL, SHORT_READS)) {
        chip_change(RCC_CFGR, RCC_CFGR_SW_MASK, RCC_CFGR_SW_HSI);
        return false;
    }
    chip_change(RCC_D2CCIP1R, RCC_D2CCIP1R_FDCAN_MASK, RCC_D2CCIP1R_FDCAN_PLL);
    return true;
}

static bool crystal_fits(uint32_t crystal_hz)
{
    return crystal_hz >= CRYSTAL_MIN_HZ && crystal_hz <= CRYSTAL_MAX_HZ && crystal_hz % MHZ == 0 &&
           input_mhz(crystal_hz / MHZ) != 0;
}

static enum clock_source start_source(uint32_t crystal_hz)
{
    if (crystal_fits(crystal_hz) && start_crystal() &&
        start_pll(crystal_hz / MHZ, RCC_PLLCKSELR_HSE) && switch_to_pll()) {
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
    clock->bus2_hz = PLL_HZ / 4;
    clock->timer1_hz = PLL_HZ / 2;
    clock->timer2_hz = PLL_HZ / 2;
    clock->can_hz = CAN_HZ;
}

/* The buses undivided. Without the PLL the CAN controller has no clock. */
static void set_slow(struct clock *clock)
{
    chip_change(RCC_D1CFGR, RCC_D1CFGR_MASK, 0);
    chip_change(RCC_D2CFGR, RCC_D2CFGR_MASK, 0);
    chip_change(RCC_D3CFGR, RCC_D3CFGR_MASK, 0);
    clock->core_hz = INTERNAL_HZ;
    clock->bus1_hz = INTERNAL_HZ;
    clock->bus2_hz = INTERNAL_HZ;
    clock->timer1_hz = INTERNAL_HZ;
    clock->timer2_hz = INTERNAL_HZ;
    clock->can_hz = 0;
}

void takt_clock_start(struct clock *clock, uint32_t crystal_hz)
{
    clock->source = start_source(crystal_hz);
    if (clock->source == CLOCK_SLOW)
        set_slow(clock);
    else
        set_fast(clock);
}
