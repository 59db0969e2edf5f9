#include "stm32/quadrature.h"

#include "chip/peripherals.h"
#include "stm32/chip.h"

#define TIM3  0x40000400U
#define CR1   (TIM3 + 0x00U)
#define SMCR  (TIM3 + 0x08U)
#define SR    (TIM3 + 0x10U)
#define EGR   (TIM3 + 0x14U)
#define CCMR1 (TIM3 + 0x18U)
#define CCMR2 (TIM3 + 0x1CU)
#define CCER  (TIM3 + 0x20U)
#define CNT   (TIM3 + 0x24U)
#define PSC   (TIM3 + 0x28U)
#define ARR   (TIM3 + 0x2CU)
#define CCR3  (TIM3 + 0x3CU)

#define CR1_ON     1U
#define SMCR_BOTH  3U /* encoder mode 3: every edge of both tracks */
#define EGR_UPDATE 1U
#define SR_EDGE(i) (1U << (3U + (unsigned)(i)))

/*
 * Inputs, of the pins of their own channels; an edge counts when it has stood for 8 clocks of the
 * timer.
 */
#define FILTER    3U
#define CCMR_BOTH ((1U | FILTER << 4) | (1U | FILTER << 4) << 8)

/* Channels 3 and 4 capture: 3 rising edges, 4 both. */
#define CCER_EDGES (1U << 8 | (1U << 12 | 1U << 13 | 1U << 15))

#define COUNTS_MAX 0xFFFFU

void takt_quadrature_open(struct quadrature *quadrature)
{
    *quadrature = (struct quadrature){0};
    chip_change(RCC_APB1ENR, 0, RCC_APB1ENR_TIM3);
    takt_chip_write(CR1, 0);
    takt_chip_write(PSC, 0);
    takt_chip_write(ARR, COUNTS_MAX);
    takt_chip_write(SMCR, SMCR_BOTH);
    takt_chip_write(CCMR1, CCMR_BOTH);
    takt_chip_write(CCMR2, CCMR_BOTH);
    takt_chip_write(EGR, EGR_UPDATE);
    takt_chip_write(CNT, 0);
    takt_chip_write(CCER, CCER_EDGES);
    takt_chip_write(SR, 0);
    takt_chip_write(CR1, CR1_ON);
}

/* Way between two counts of 16 bits, which are less than half a round apart. */
static int64_t way(uint16_t from, uint16_t to)
{
    return (int16_t)(uint16_t)(to - from);
}

int64_t takt_quadrature_read(struct quadrature *quadrature)
{
    const uint16_t now = (uint16_t)takt_chip_read(CNT);

    quadrature->counts += way(quadrature->seen, now);
    quadrature->seen = now;
    return quadrature->counts;
}

/* Reading what was captured takes the flag back. */
bool takt_quadrature_take_edge(struct quadrature *quadrature, enum quadrature_edge edge,
                               int64_t *counts)
{
    if ((takt_chip_read(SR) & SR_EDGE(edge)) == 0)
        return false;
    *counts = quadrature->counts +
              way(quadrature->seen, (uint16_t)takt_chip_read(CCR3 + 4U * (uint32_t)edge));
    return true;
}
