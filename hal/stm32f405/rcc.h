/*
 * Registers of the reset and clock control, the power controller and the flash interface's wait
 * states.
 */
#ifndef TAKT_STM32F405_RCC_H
#define TAKT_STM32F405_RCC_H

#define RCC_CR      0x40023800U
#define RCC_PLLCFGR 0x40023804U
#define RCC_CFGR    0x40023808U
#define RCC_AHB1ENR 0x40023830U
#define RCC_APB1ENR 0x40023840U
#define RCC_APB2ENR 0x40023844U
#define RCC_RESETS  0x40023874U

#define RCC_CR_HSION  (1U << 0)
#define RCC_CR_HSIRDY (1U << 1)
#define RCC_CR_HSEON  (1U << 16)
#define RCC_CR_HSERDY (1U << 17)
#define RCC_CR_CSSON  (1U << 19)
#define RCC_CR_PLLON  (1U << 24)
#define RCC_CR_PLLRDY (1U << 25)

#define RCC_PLLCFGR_N(n)       ((n) << 6)
#define RCC_PLLCFGR_P_MASK     (3U << 16)
#define RCC_PLLCFGR_HSE        (1U << 22)
#define RCC_PLLCFGR_Q(q)       ((q) << 24)
#define RCC_PLLCFGR_WRITE_MASK 0x0F437FFFU

#define RCC_CFGR_SW_MASK    (3U << 0)
#define RCC_CFGR_SW_HSI     (0U << 0)
#define RCC_CFGR_SW_PLL     (2U << 0)
#define RCC_CFGR_SWS_MASK   (3U << 2)
#define RCC_CFGR_SWS_HSI    (0U << 2)
#define RCC_CFGR_SWS_PLL    (2U << 2)
#define RCC_CFGR_HPRE_MASK  (15U << 4)
#define RCC_CFGR_PPRE1_MASK (7U << 10)
#define RCC_CFGR_PPRE1_4    (5U << 10)
#define RCC_CFGR_PPRE2_MASK (7U << 13)
#define RCC_CFGR_PPRE2_2    (4U << 13)

#define RCC_AHB1ENR_DMA2   (1U << 22)
#define RCC_APB1ENR_TIM2   (1U << 0)
#define RCC_APB1ENR_TIM3   (1U << 1)
#define RCC_APB1ENR_TIM5   (1U << 3)
#define RCC_APB1ENR_USART2 (1U << 17)
#define RCC_APB1ENR_CAN1   (1U << 25)
#define RCC_APB1ENR_PWR    (1U << 28)
#define RCC_APB2ENR_TIM1   (1U << 0)
#define RCC_APB2ENR_TIM8   (1U << 1)
#define RCC_APB2ENR_USART1 (1U << 4)

/* Why the chip has been reset (CSR). */
#define RCC_RESETS_FORGET   (1U << 24)
#define RCC_RESETS_WATCHDOG (1U << 29)

#define PWR_CR     0x40007000U
#define PWR_CR_VOS (1U << 14) /* the regulator's mode for more than 144 MHz */

#define FLASH_ACR              0x40023C00U
#define FLASH_ACR_LATENCY_MASK (7U << 0)
#define FLASH_ACR_PREFETCH     (1U << 8)
#define FLASH_ACR_ICACHE       (1U << 9)
#define FLASH_ACR_DCACHE       (1U << 10)
#define FLASH_ACR_DCACHE_RESET (1U << 12)

#endif
