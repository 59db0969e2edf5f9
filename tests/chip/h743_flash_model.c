/*
 * The flash controller of the second bank, its last two sectors, and the code over each of its
 * words (RM0433, chapter 4).
 */
#include "h743_flash_model.h"
#include "chip_model.h"
#include "clock_model.h"
#include "flash_model.h"
#include "stm32h743/peripherals.h"

#include <string.h>

#define BASE 0x52002000U
#define ACR  0x000U
#define KEYR 0x104U
#define CR   0x10CU
#define SR   0x110U
#define CCR  0x114U

#define BUSY     5U /* an operation under way, and one that waits */
#define FILLING  2U
#define PROTECT  (1U << 17)
#define SEQUENCE (1U << 18)
#define DAMAGED  (1U << 26)
#define LOCK     1U
#define START    (1U << 7)

#define ERASE_READS   5000U
#define PROGRAM_READS 20U
#define BAD_CELL      0x1224U
#define LINE          32U
#define LINES         (FLASH_MODEL_BYTES / LINE)

struct flash_model flash_model;
uint8_t flash_model_memory[FLASH_MODEL_BYTES];

/* What the core's cache may still hold of a line; a word whose code fits nothing. */
static bool is_old[LINES], is_torn[LINES], is_used[LINES];
static uint32_t status, control;
static uint8_t filling[LINE];
static unsigned keys, filled;
static bool is_shut; /* a wrong key: until the reset */
static uint64_t busy_until;

static void reset(void)
{
    flash_model = (struct flash_model){0};
    status = 0;
    control = LOCK;
    keys = filled = 0;
    is_shut = false;
    busy_until = 0;
}

void flash_model_blank(void)
{
    memset(flash_model_memory, 0xFF, sizeof flash_model_memory);
    memset(is_old, 0, sizeof is_old);
    memset(is_torn, 0, sizeof is_torn);
    memset(is_used, 0, sizeof is_used);
}

bool flash_model_is_locked(void)
{
    return (control & LOCK) != 0;
}

void h743_flash_model_tear(uint32_t offset)
{
    is_torn[offset / LINE] = true;
    flash_model_memory[offset] = 0x5A;
}

static bool is_busy(void)
{
    return chip_model_reads() < busy_until;
}

static uint32_t read(uint32_t offset)
{
    switch (offset) {
    case ACR:
        return clock_model_read_acr();
    case SR:
        return status | (is_busy() ? BUSY : 0) | (filled > 0 ? FILLING : 0);
    case CR:
        return control;
    default:
        return 0;
    }
}

static void take_key(uint32_t key)
{
    static const uint32_t right[] = {0x45670123U, 0xCDEF89ABU};

    if (is_shut || key != right[keys]) {
        is_shut = true;
        return;
    }
    if (++keys == 2) {
        keys = 0;
        control &= ~LOCK;
    }
}

static void be_busy(uint32_t reads)
{
    busy_until = flash_model.never_ends ? UINT64_MAX : chip_model_reads() + reads;
}

static void erase(uint32_t sector)
{
    const uint32_t from = sector * FLASH_SECTOR_BYTES, line = from / LINE;

    memset(flash_model_memory + from, 0xFF, FLASH_SECTOR_BYTES);
    memset(is_torn + line, false, FLASH_SECTOR_BYTES / LINE);
    memset(is_used + line, false, FLASH_SECTOR_BYTES / LINE);
    memset(is_old + line, true, FLASH_SECTOR_BYTES / LINE);
    flash_model.erased++;
    be_busy(ERASE_READS);
}

static void start_erase(void)
{
    const uint32_t sector = (control >> 8 & 7U) - FLASH_SECTOR_NUMBER;

    if (flash_model.is_protected)
        status |= PROTECT;
    else if ((control & 4U) == 0 || sector > 1)
        chip_model_break("a sector that is not for settings is erased, or none");
    else
        erase(sector);
}

static void write_control(uint32_t value)
{
    if (is_busy() && !flash_model.never_ends)
        chip_model_break("the flash controller is written while it is busy");
    if ((control & LOCK) != 0) {
        if ((value & ~LOCK) != 0)
            chip_model_break("the flash controller is written while it is locked");
        return;
    }
    control = value & ~START;
    if ((value & START) != 0)
        start_erase();
}

static void write(uint32_t offset, uint32_t value)
{
    if (offset == ACR)
        clock_model_write_acr(value);
    else if (offset == KEYR)
        take_key(value);
    else if (offset == CCR)
        status &= ~value;
    else if (offset == CR)
        write_control(value);
}

const struct chip_block chip_flash = {BASE, 0x400U, read, write, reset};

/* ---- the memory itself, and the cache before it ---- */

static uint32_t read_memory(uint32_t offset)
{
    uint32_t word;

    if (is_torn[offset / LINE])
        chip_model_break("a word beyond repair is read, which is a bus fault");
    if (is_old[offset / LINE])
        chip_model_break("flash that has changed is read out of the cache");
    memcpy(&word, flash_model_memory + offset, sizeof word);
    return word;
}

/* The code is programmed with the word: a second time it would be that of neither. */
static void program(uint32_t line)
{
    uint8_t *to = flash_model_memory + (size_t)line * LINE;

    filled = 0;
    if (is_used[line]) {
        chip_model_break("a word is programmed twice");
        return;
    }
    for (unsigned i = 0; i < LINE; i++)
        to[i] &= filling[i];
    if (flash_model.has_bad_cell && line == BAD_CELL / LINE)
        to[BAD_CELL % LINE] |= 1U;
    is_used[line] = is_old[line] = true;
    flash_model.programmed++;
    be_busy(PROGRAM_READS);
}

static void write_memory(uint32_t offset, uint32_t value)
{
    if (is_busy())
        chip_model_break("the flash is programmed while it is busy");
    if (flash_model.is_protected || (control & (LOCK | 2U)) != 2U) {
        status |= flash_model.is_protected ? PROTECT : SEQUENCE;
        return;
    }
    if (offset % LINE != filled)
        chip_model_break("the parts of a word are not written in order");
    memcpy(filling + filled, &value, sizeof value);
    filled += sizeof value;
    if (filled == LINE)
        program(offset / LINE);
}

static void reset_memory(void)
{
    /* Power-off does not change it. */
}

const struct chip_block chip_flash_memory = {FLASH_SECTOR_ADDRESS, FLASH_MODEL_BYTES, read_memory,
                                             write_memory, reset_memory};

void takt_peripherals_forget(uint32_t address, uint32_t bytes)
{
    for (uint32_t at = 0; at < bytes; at += LINE)
        is_old[(address - FLASH_SECTOR_ADDRESS + at) / LINE] = false;
}

/* The model has an order. */
void takt_peripherals_order(void)
{
}

void takt_peripherals_touch(uint32_t address)
{
    if (is_torn[(address - FLASH_SECTOR_ADDRESS) / LINE])
        status |= DAMAGED;
}
