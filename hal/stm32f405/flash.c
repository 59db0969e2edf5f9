/*
 * The flash controller (RM0090, chapter 3): the processor stands still 16 us for a word of 32 bits,
 * up to 2 s for a sector.
 */
#include "stm32/flash.h"

#include "stm32/chip.h"
#include "stm32/watchdog.h"
#include "stm32f405/peripherals.h"

#include <string.h>

#define FLASH_KEYR 0x40023C04U
#define FLASH_SR   0x40023C0CU
#define FLASH_CR   0x40023C10U

#define KEY1 0x45670123U
#define KEY2 0xCDEF89ABU

#define SR_END    (1U << 0)
#define SR_ERRORS 0xF2U /* operation, write protection, alignment, parallelism, sequence */
#define SR_BUSY   (1U << 16)

#define CR_PROGRAM   (1U << 0)
#define CR_ERASE     (1U << 1)
#define CR_SECTOR(n) ((n) << 3)
#define CR_32_BITS   (2U << 8)
#define CR_START     (1U << 16)
#define CR_LOCK      (1U << 31)

/*
 * Reads of the status: code in flash stands still meanwhile and needs few; code in RAM would read
 * some 25 million times a second.
 */
#define ERASE_READS   100000000U
#define PROGRAM_READS 10000U

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
    takt_chip_write(FLASH_SR, SR_END | SR_ERRORS);
    return true;
}

/* Waits for the end of what has been started. */
static bool complete(struct flash *flash, uint32_t reads)
{
    if (!chip_wait(FLASH_SR, SR_BUSY, 0, reads))
        return fail(flash, FLASH_BUSY);
    if ((takt_chip_read(FLASH_SR) & SR_ERRORS) != 0)
        return fail(flash, FLASH_REFUSED);
    return true;
}

/* The data cache may hold what was there before. */
static void forget_cache(void)
{
    const uint32_t cache = takt_chip_read(FLASH_ACR) & FLASH_ACR_DCACHE;

    chip_change(FLASH_ACR, FLASH_ACR_DCACHE, 0);
    chip_change(FLASH_ACR, 0, FLASH_ACR_DCACHE_RESET);
    chip_change(FLASH_ACR, FLASH_ACR_DCACHE_RESET, cache);
}

static void lock(void)
{
    takt_chip_write(FLASH_CR, CR_LOCK);
    forget_cache();
}

/* The watchdog has to wait for an erase longer than for a cycle. */
static bool erase(void *context, unsigned sector)
{
    struct flash *flash = context;
    bool good = unlock(flash);

    if (good) {
        const uint32_t control = CR_ERASE | CR_32_BITS | CR_SECTOR(FLASH_SECTOR_NUMBER + sector);

        (void)takt_watchdog_start(FLASH_WATCHDOG_MS);
        takt_chip_write(FLASH_CR, control);
        takt_chip_write(FLASH_CR, control | CR_START);
        good = complete(flash, ERASE_READS);
        (void)takt_watchdog_start(FLASH_WATCHDOG_MS_RUN);
    }
    lock();
    return good;
}

static uint32_t word_at(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
           (uint32_t)bytes[3] << 24;
}

static bool program_word(struct flash *flash, uint32_t address, uint32_t word)
{
    takt_chip_write(address, word);
    if (!complete(flash, PROGRAM_READS))
        return false;
    return takt_chip_read(address) == word || fail(flash, FLASH_DIFFERS);
}

static bool program(void *context, unsigned sector, uint32_t offset, const uint8_t *bytes,
                    uint32_t words)
{
    const uint32_t address = FLASH_SECTOR_ADDRESS + sector * FLASH_SECTOR_BYTES + offset;
    struct flash *flash = context;
    bool good = unlock(flash);

    if (good)
        takt_chip_write(FLASH_CR, CR_PROGRAM | CR_32_BITS);
    for (uint32_t i = 0; i < words * FLASH_WORD_BYTES && good; i += 4)
        good = program_word(flash, address + i, word_at(bytes + i));
    lock();
    return good;
}

struct flash_port takt_flash_get_port(struct flash *flash, const uint8_t *mapped)
{
    memset(flash, 0, sizeof *flash);
    return (struct flash_port){.sector_bytes = FLASH_SECTOR_BYTES,
                               .sector = {mapped, mapped + FLASH_SECTOR_BYTES},
                               .erase = erase,
                               .program = program,
                               .context = flash};
}
