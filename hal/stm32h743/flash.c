/*
 * The flash controller of the second bank (RM0433, 4.9): 256 bits at a time, which have a code that
 * corrects one bit.
 */
#include "stm32/flash.h"

#include "stm32/chip.h"
#include "stm32/watchdog.h"
#include "stm32h743/peripherals.h"

#include <string.h>

#define FLASH_KEYR 0x52002104U
#define FLASH_CR   0x5200210CU
#define FLASH_SR   0x52002110U
#define FLASH_CCR  0x52002114U

#define KEY1 0x45670123U
#define KEY2 0xCDEF89ABU

#define SR_BUSY    7U /* a word being filled or waiting, an operation under way */
#define SR_ERRORS  0x07EE0000U
#define SR_DAMAGED (1U << 26) /* two bits of a word that has been read: beyond repair */

#define CR_LOCK      (1U << 0)
#define CR_PROGRAM   (1U << 1)
#define CR_ERASE     (1U << 2)
#define CR_64_BITS   (3U << 4) /* at once: the fastest, and the most current */
#define CR_START     (1U << 7)
#define CR_SECTOR(n) ((n) << 8)

/* Reads of the status, some 20 million a second: an erase takes up to 4 s, a word up to 1 ms. */
#define ERASE_READS   200000000U
#define PROGRAM_READS 50000U

static bool fail(struct flash *flash, enum flash_problem problem)
{
    flash->problem = problem;
    flash->status = takt_chip_read(FLASH_SR);
    return false;
}

static bool unlock(struct flash *flash)
{
    if (!chip_wait(FLASH_SR, SR_BUSY, 0, PROGRAM_READS))
        return fail(flash, FLASH_BUSY);
    if ((takt_chip_read(FLASH_CR) & CR_LOCK) != 0) {
        takt_chip_write(FLASH_KEYR, KEY1);
        takt_chip_write(FLASH_KEYR, KEY2);
    }
    if ((takt_chip_read(FLASH_CR) & CR_LOCK) != 0)
        return fail(flash, FLASH_LOCKED);
    takt_chip_write(FLASH_CCR, SR_ERRORS);
    return true;
}

static bool complete(struct flash *flash, uint32_t reads)
{
    if (!chip_wait(FLASH_SR, SR_BUSY, 0, reads))
        return fail(flash, FLASH_BUSY);
    if ((takt_chip_read(FLASH_SR) & SR_ERRORS) != 0)
        return fail(flash, FLASH_REFUSED);
    return true;
}

static uint32_t address_of(unsigned sector)
{
    return FLASH_SECTOR_ADDRESS + sector * FLASH_SECTOR_BYTES;
}

/* The watchdog has to wait for an erase longer than for a cycle. */
static bool erase(void *context, unsigned sector)
{
    struct flash *flash = context;
    bool good = unlock(flash);

    if (good) {
        (void)takt_watchdog_start(FLASH_WATCHDOG_MS);
        takt_chip_write(FLASH_CR, CR_ERASE | CR_64_BITS | CR_SECTOR(FLASH_SECTOR_NUMBER + sector));
        chip_change(FLASH_CR, 0, CR_START);
        good = complete(flash, ERASE_READS);
        (void)takt_watchdog_start(FLASH_WATCHDOG_MS_RUN);
    }
    takt_chip_write(FLASH_CR, CR_LOCK);
    takt_peripherals_forget(address_of(sector), FLASH_SECTOR_BYTES);
    return good;
}

static uint32_t word_at(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
           (uint32_t)bytes[3] << 24;
}

/*
 * It begins by itself when its last part has been written. A word that is not blank would get a
 * code that fits nothing.
 */
static bool program_word(struct flash *flash, uint32_t address, const uint8_t *bytes)
{
    for (uint32_t i = 0; i < FLASH_WORD_BYTES; i += 4) {
        if (takt_chip_read(address + i) != UINT32_MAX)
            return fail(flash, FLASH_DIFFERS);
    }
    takt_peripherals_order();
    for (uint32_t i = 0; i < FLASH_WORD_BYTES; i += 4)
        takt_chip_write(address + i, word_at(bytes + i));
    takt_peripherals_order();
    if (!complete(flash, PROGRAM_READS))
        return false;
    takt_peripherals_forget(address, FLASH_WORD_BYTES);
    for (uint32_t i = 0; i < FLASH_WORD_BYTES; i += 4) {
        if (takt_chip_read(address + i) != word_at(bytes + i))
            return fail(flash, FLASH_DIFFERS);
    }
    return true;
}

static bool program(void *context, unsigned sector, uint32_t offset, const uint8_t *bytes,
                    uint32_t words)
{
    struct flash *flash = context;
    bool good = unlock(flash);

    if (good)
        takt_chip_write(FLASH_CR, CR_PROGRAM | CR_64_BITS);
    for (uint32_t i = 0; i < words && good; i++)
        good = program_word(flash, address_of(sector) + offset + FLASH_WORD_BYTES * i,
                            bytes + (size_t)FLASH_WORD_BYTES * i);
    takt_chip_write(FLASH_CR, CR_LOCK);
    return good;
}

static bool is_readable(unsigned sector)
{
    takt_chip_write(FLASH_CCR, SR_ERRORS);
    for (uint32_t at = 0; at < FLASH_SECTOR_BYTES; at += FLASH_WORD_BYTES)
        takt_peripherals_touch(address_of(sector) + at);
    return (takt_chip_read(FLASH_SR) & SR_DAMAGED) == 0;
}

/*
 * Where power has failed while a word was being programmed, its code fits nothing and reading it is
 * a bus fault. Such a sector holds no set that counts: it is erased before anybody looks.
 */
struct flash_port takt_flash_get_port(struct flash *flash, const uint8_t *mapped)
{
    memset(flash, 0, sizeof *flash);
    for (unsigned i = 0; i < FLASH_SECTORS; i++) {
        if (!is_readable(i))
            (void)erase(flash, i);
    }
    return (struct flash_port){.sector_bytes = FLASH_SECTOR_BYTES,
                               .sector = {mapped, mapped + FLASH_SECTOR_BYTES},
                               .erase = erase,
                               .program = program,
                               .context = flash};
}
