/*
 * What drivers of hal/stm32 need to know of this chip: where peripherals lie, and what is beside
 * them.
 */
#ifndef TAKT_STM32H743_PERIPHERALS_H
#define TAKT_STM32H743_PERIPHERALS_H

#include "stm32/chip.h"
#include "stm32h743/rcc.h"

#include <stddef.h>

#define PERIPHERALS_CHIP "STM32H743"

#define GPIO_BASE    0x58020000U
#define GPIO_CLOCKS  RCC_AHB4ENR /* where the ports are switched on: bit 0 is port A */
#define WATCHDOG     0x58004800U
#define STEP_DMA     0x40020400U /* DMA2 */
#define STEP_REQUEST 0U /* in the control register of its stream 1: the multiplexer says who asks */

/*
 * Sectors 6 and 7 of the second bank: the program in the first one goes on while they are erased
 * and programmed.
 */
#define FLASH_SECTOR_BYTES   0x20000U
#define FLASH_SECTOR_ADDRESS 0x081C0000U /* of the first; the other follows */
#define FLASH_SECTOR_NUMBER  6U

/*
 * Stream 1 of DMA2 is channel 9 of the multiplexer, updates of TIM8 are request 51 (RM0433, 17.3).
 */
static inline void peripherals_route_steps(void)
{
    takt_chip_write(0x40020824U, 51U);
}

/* What the processor has written can be read by others, and is kept by a reset (cache.c). */
void peripherals_write_back(const void *memory, size_t bytes);

/*
 * What has been written is there before anything that follows: memory, flash too, has no order with
 * registers.
 */
void takt_peripherals_order(void);

/* What others have written is read anew. */
void takt_peripherals_forget(uint32_t address, uint32_t bytes);

/*
 * Reads a word that may be damaged beyond repair, which is a fault else; the memory's own status
 * tells.
 */
void takt_peripherals_touch(uint32_t address);

#endif
