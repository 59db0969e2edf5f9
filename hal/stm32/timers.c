#include "stm32/timers.h"

#include "chip/peripherals.h"
#include "stm32/chip.h"

#define TIM2 0x40000000U
#define TIM5 0x40000C00U

#define CR1  0x00U
#define DIER 0x0CU
#define SR   0x10U
#define EGR  0x14U
#define CNT  0x24U
#define PSC  0x28U
#define ARR  0x2CU

#define CR1_ON      1U
#define DIER_UPDATE 1U
#define SR_UPDATE   1U
#define EGR_UPDATE  1U /* takes over prescaler and period, and begins at 0 */

#define HZ_PER_MHZ 1000000U

static void start(uint32_t timer, uint32_t timer_hz, uint32_t period)
{
    takt_chip_write(timer + CR1, 0);
    takt_chip_write(timer + PSC, timer_hz / HZ_PER_MHZ - 1U);
    takt_chip_write(timer + ARR, period);
    takt_chip_write(timer + EGR, EGR_UPDATE);
    takt_chip_write(timer + SR, 0);
}

void takt_timers_start_clock(uint32_t timer_hz)
{
    chip_change(RCC_APB1ENR, 0, RCC_APB1ENR_TIM5);
    start(TIM5, timer_hz, UINT32_MAX);
    takt_chip_write(TIM5 + CR1, CR1_ON);
}

uint32_t takt_timers_now_us(void)
{
    return takt_chip_read(TIM5 + CNT);
}

void takt_timers_start_cycle(uint32_t timer_hz, uint32_t cycle_us)
{
    chip_change(RCC_APB1ENR, 0, RCC_APB1ENR_TIM2);
    start(TIM2, timer_hz, cycle_us - 1U);
    takt_chip_write(TIM2 + DIER, DIER_UPDATE);
    takt_chip_write(TIM2 + CR1, CR1_ON);
}

void takt_timers_take_cycle(void)
{
    takt_chip_write(TIM2 + SR, ~SR_UPDATE);
}

bool takt_timers_cycle_is_due(void)
{
    return (takt_chip_read(TIM2 + SR) & SR_UPDATE) != 0;
}
