/*
 * Registers of the reset and clock control, the power controller and the flash interface's wait
 * states (RM0433, 8.7, 6.8, 4.9).
 */
#ifndef TAKT_STM32H743_RCC_H
#define TAKT_STM32H743_RCC_H

#define RCC_CR        0x58024400U
#define RCC_CFGR      0x58024410U
#define RCC_D1CFGR    0x58024418U
#define RCC_D2CFGR    0x5802441CU
#define RCC_D3CFGR    0x58024420U
#define RCC_PLLCKSELR 0x58024428U
#define RCC_PLLCFGR   0x5802442CU
#define RCC_PLL1DIVR  0x58024430U
#define RCC_D2CCIP1R  0x58024450U
#define RCC_RESETS    0x580244D0U
#define RCC_AHB1ENR   0x580244D8U
#define RCC_AHB4ENR   0x580244E0U
#define RCC_APB1ENR   0x580244E8U /* its lower half; the upper one: */
#define RCC_APB1HENR  0x580244ECU
#define RCC_APB2ENR   0x580244F0U

#define RCC_CR_HSION  (1U << 0)
#define RCC_CR_HSIRDY (1U << 2)
#define RCC_CR_HSEON  (1U << 16)
#define RCC_CR_HSERDY (1U << 17)
#define RCC_CR_CSSON  (1U << 19)
#define RCC_CR_PLLON  (1U << 24)
#define RCC_CR_PLLRDY (1U << 25)

#define RCC_CFGR_SW_MASK  7U
#define RCC_CFGR_SW_HSI   0U
#define RCC_CFGR_SW_PLL   3U
#define RCC_CFGR_SWS_MASK (7U << 3)
#define RCC_CFGR_SWS_PLL  (3U << 3)

/*
 * Dividers by two: of the buses' clock out of the core's, and of all peripheral buses out of that.
 */
#define RCC_D1CFGR_HPRE_2   (8U << 0)
#define RCC_D1CFGR_D1PPRE_2 (4U << 4)
#define RCC_D1CFGR_MASK     0xF7FU
#define RCC_D2CFGR_PPRE1_2  (4U << 4)
#define RCC_D2CFGR_PPRE2_2  (4U << 8)
#define RCC_D2CFGR_MASK     0x770U
#define RCC_D3CFGR_PPRE_2   (4U << 4)
#define RCC_D3CFGR_MASK     0x70U

#define RCC_PLLCKSELR_MASK    0x3F3U /* source and divider of PLL 1 */
#define RCC_PLLCKSELR_HSE     2U
#define RCC_PLLCKSELR_DIVM(m) ((m) << 4)

#define RCC_PLLCFGR_MASK    0x7000FU  /* of PLL 1 */
#define RCC_PLLCFGR_2_4_MHZ (1U << 2) /* its input; the oscillator is the wide one */
#define RCC_PLLCFGR_4_8_MHZ (2U << 2)
#define RCC_PLLCFGR_P_Q     (3U << 16)

#define RCC_PLL1DIVR_N(n) ((n)-1U)
#define RCC_PLL1DIVR_P(p) (((p)-1U) << 9)
#define RCC_PLL1DIVR_Q(q) (((q)-1U) << 16)
#define RCC_PLL1DIVR_R(r) (((r)-1U) << 24)

#define RCC_D2CCIP1R_FDCAN_MASK (3U << 28)
#define RCC_D2CCIP1R_FDCAN_PLL  (1U << 28) /* output Q of PLL 1 */

#define RCC_AHB1ENR_DMA2   (1U << 1)
#define RCC_APB1ENR_TIM2   (1U << 0)
#define RCC_APB1ENR_TIM3   (1U << 1)
#define RCC_APB1ENR_TIM5   (1U << 3)
#define RCC_APB1ENR_USART2 (1U << 17)
#define RCC_APB1HENR_FDCAN (1U << 8)
#define RCC_APB2ENR_TIM1   (1U << 0)
#define RCC_APB2ENR_TIM8   (1U << 1)
#define RCC_APB2ENR_USART1 (1U << 4)

/* Why the chip has been reset (RSR). */
#define RCC_RESETS_FORGET   (1U << 16)
#define RCC_RESETS_WATCHDOG (1U << 26)

#define PWR_CSR1          0x58024804U
#define PWR_CR3           0x5802480CU
#define PWR_D3CR          0x58024818U
#define PWR_CSR1_SUPPLIED (1U << 13)
#define PWR_CR3_BYPASS    (1U << 0)
#define PWR_CR3_LDO       (1U << 1)
#define PWR_CR3_OPEN      (1U << 2) /* the supply can still be chosen: once after power-on */
#define PWR_D3CR_VOS_MASK (3U << 14)
#define PWR_D3CR_VOS_1    (3U << 14) /* the regulator's mode for up to 400 MHz */
#define PWR_D3CR_READY    (1U << 13)

#define FLASH_ACR      0x52002000U
#define FLASH_ACR_MASK 0x3FU

#endif
