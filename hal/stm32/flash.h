/*
 * Two sectors of the chip's own flash behind hal/flash.h, which the program does not reach
 * (chip/peripherals.h). A part of flash that is erased or programmed cannot be read meanwhile, for
 * 1 to 4 s; where the program lies in it, the processor stands still. So settings are brought while
 * the drives are off.
 */
#ifndef TAKT_STM32_FLASH_H
#define TAKT_STM32_FLASH_H

#include "hal/flash.h"

/* Timeout of the watchdog while a sector is erased, and otherwise. */
#define FLASH_WATCHDOG_MS     8000U
#define FLASH_WATCHDOG_MS_RUN 250U

/* Why the last call failed. */
enum flash_problem {
    FLASH_GOOD,
    FLASH_BUSY,    /* does not come to an end */
    FLASH_LOCKED,  /* does not take the keys: only a reset helps */
    FLASH_REFUSED, /* write protection, alignment, sequence: the status register says which */
    FLASH_DIFFERS  /* what it holds afterwards is not what was written */
};

/* Private. */
struct flash {
    enum flash_problem problem;
    uint32_t status; /* the status register with it */
};

/* mapped: where the first sector can be read: FLASH_SECTOR_ADDRESS on the chip. */
struct flash_port takt_flash_get_port(struct flash *flash, const uint8_t *mapped);

#endif
