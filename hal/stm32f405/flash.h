/*
 * The chip's own flash behind hal/flash.h: sectors 10 and 11, 128 KiB each, the last of 1 MiB, which the program does
 * not reach. While a sector is erased or a word programmed the processor cannot fetch from flash and stands still: 1 to
 * 2 s for an erase, 16 us for a word. So settings are brought while the drives are off.
 */
#ifndef TAKT_STM32F405_FLASH_H
#define TAKT_STM32F405_FLASH_H

#include "hal/flash.h"

#define FLASH_SECTOR_BYTES    0x20000U
#define FLASH_SECTOR_ADDRESS  0x080C0000U /* of the first; the other follows */
#define FLASH_SECTOR_NUMBER   10U
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
struct flash_port flash_get_port(struct flash *flash, const uint8_t *mapped);

#endif
