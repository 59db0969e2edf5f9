/*
 * Contract of the memory that settings are kept in over power-off: two sectors of NOR flash, or
 * something that behaves so.
 *
 * Erasing sets every byte of a sector to 0xFF; programming only clears bits. Power may fail at any
 * moment: a word being programmed then holds any part of its zeros, a sector being erased anything.
 */
#ifndef TAKT_HAL_FLASH_H
#define TAKT_HAL_FLASH_H

#include <stdbool.h>
#include <stdint.h>

#define FLASH_SECTORS 2

/*
 * What is programmed at once: as much as any chip wants that has a code over it (STM32H7). Once
 * between two erasures.
 */
#define FLASH_WORD_BYTES 32

struct flash_port {
    uint32_t sector_bytes;                /* of each sector */
    const uint8_t *sector[FLASH_SECTORS]; /* for reading, at addresses that are multiples of 8 */
    /*
     * May keep the processor waiting for seconds: no drive may be enabled. False: it could not be
     * done.
     */
    bool (*erase)(void *context, unsigned sector);
    /*
     * Programs words; offset: a multiple of FLASH_WORD_BYTES. False: they do not read as they
     * should.
     */
    bool (*program)(void *context, unsigned sector, uint32_t offset, const uint8_t *bytes,
                    uint32_t words);
    void *context; /* owned by whoever made the port */
};

#endif
