/*
 * How the drivers touch the chip: by these few functions and nothing else. On the chip they are
 * loads and stores (chip_memory.c); a test links a model of the registers instead, and the same
 * drivers run on it.
 *
 * Addresses and bits are those of ST's reference manuals: RM0090 for the STM32F405, RM0433 for the
 * STM32H743.
 */
#ifndef TAKT_STM32_CHIP_H
#define TAKT_STM32_CHIP_H

#include <stdbool.h>
#include <stdint.h>

uint32_t takt_chip_read(uint32_t address);
void takt_chip_write(uint32_t address, uint32_t value);

/*
 * No interrupt from here to takt_chip_unlock, which takes what takt_chip_lock returned. May be
 * nested.
 */
uint32_t takt_chip_lock(void);
void takt_chip_unlock(uint32_t before);

/* Clears bits, then sets others. */
static inline void chip_change(uint32_t address, uint32_t clear, uint32_t set)
{
    takt_chip_write(address, (takt_chip_read(address) & ~clear) | set);
}

/*
 * Every wait for the hardware has an end: reads until the bits of mask have this value, reads times
 * at most. False: they did not.
 */
static inline bool chip_wait(uint32_t address, uint32_t mask, uint32_t value, uint32_t reads)
{
    while (reads-- > 0) {
        if ((takt_chip_read(address) & mask) == value)
            return true;
    }
    return false;
}

#endif
