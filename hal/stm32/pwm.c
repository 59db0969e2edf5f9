#include "stm32/pwm.h"

#include "chip/peripherals.h"
#include "stm32/chip.h"

#define TIM1  0x40010000U
#define CR1   (TIM1 + 0x00U)
#define SR    (TIM1 + 0x10U)
#define EGR   (TIM1 + 0x14U)
#define CCMR1 (TIM1 + 0x18U)
#define CCER  (TIM1 + 0x20U)
#define PSC   (TIM1 + 0x28U)
#define ARR   (TIM1 + 0x2CU)
#define CCR1  (TIM1 + 0x34U)
#define CCR2  (TIM1 + 0x38U)
#define BDTR  (TIM1 + 0x44U)

#define CR1_ON      1U
#define CR1_PRELOAD (1U << 7)
#define SR_BREAK    (1U << 7)
#define EGR_UPDATE  1U
#define CCMR1_PWM   (6U << 4 | 6U << 12) /* high while the counter is below the width */
#define CCMR1_LATER (1U << 3 | 1U << 11) /* widths count from the next pulse on */
#define CCER_BOTH   (1U << 0 | 1U << 4)
#define BDTR_IDLE                                                                                  \
    (1U << 10 | 1U << 11)     /* OSSI, OSSR: while they are off the timer holds both low */
#define BDTR_BREAK (1U << 12) /* by a low level */
#define BDTR_ON    (1U << 15)

uint32_t takt_pwm_open(uint32_t timer_hz, uint32_t pulses_hz)
{
    const uint32_t counts = timer_hz / pulses_hz;

    chip_change(RCC_APB2ENR, 0, RCC_APB2ENR_TIM1);
    takt_chip_write(CR1, CR1_PRELOAD);
    takt_chip_write(PSC, 0);
    takt_chip_write(ARR, counts - 1U);
    takt_chip_write(CCMR1, CCMR1_PWM | CCMR1_LATER);
    takt_chip_write(CCR1, 0);
    takt_chip_write(CCR2, 0);
    takt_chip_write(EGR, EGR_UPDATE);
    takt_chip_write(CCER, CCER_BOTH);
    takt_chip_write(BDTR, BDTR_IDLE | BDTR_BREAK);
    chip_change(CR1, 0, CR1_ON);
    return counts;
}

void takt_pwm_arm(bool on)
{
    if (on)
        takt_chip_write(SR, ~SR_BREAK);
    takt_chip_write(BDTR, BDTR_IDLE | BDTR_BREAK | (on ? BDTR_ON : 0));
}

bool takt_pwm_is_broken(void)
{
    return (takt_chip_read(SR) & SR_BREAK) != 0;
}

/* The pause first: a pulse may begin between the two. */
void takt_pwm_set(int32_t counts)
{
    const bool up = counts > 0;

    takt_chip_write(up ? CCR2 : CCR1, 0);
    takt_chip_write(up ? CCR1 : CCR2, (uint32_t)(up ? counts : -counts));
}
