/*
 * What drivers of hal/stm32 need to know of this chip: where peripherals lie, and what is beside
 * them.
 */
#ifndef TAKT_STM32F405_PERIPHERALS_H
#define TAKT_STM32F405_PERIPHERALS_H

#include "stm32f405/rcc.h"

#include <stddef.h>

#define PERIPHERALS_CHIP "STM32F405"

#define GPIO_BASE   0x40020000U
#define GPIO_CLOCKS RCC_AHB1ENR /* where the ports are switched on: bit 0 is port A */
#define WATCHDOG    0x40003000U
#define STEP_DMA    0x40026400U /* DMA2 */
/* In the control register of its stream 1: channel 7, TIM8's updates (RM0090, table 43). */
#define STEP_REQUEST (7U << 25)

/* Sectors 10 and 11, the last of 1 MiB, keep the settings. */
#define FLASH_SECTOR_BYTES   0x20000U
#define FLASH_SECTOR_ADDRESS 0x080C0000U /* of the first; the other follows */
#define FLASH_SECTOR_NUMBER  10U

/* What else leads the updates of TIM8 to that stream. */
static inline void peripherals_route_steps(void)
{
}

/*
 * What the processor has written can be read by others, and is kept by a reset: there is no cache
 * between.
 */
static inline void peripherals_write_back(const void *memory, size_t bytes)
{
    (void)memory;
    (void)bytes;
}

#endif
