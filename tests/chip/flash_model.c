#include "flash_model.h"

#include "chip_model.h"
#include "clock_model.h"
#include "stm32/flash.h"
#include "stm32f405/peripherals.h"

#include <string.h>

#define ACR  0x00U
#define KEYR 0x04U
#define SR   0x0CU
#define CR   0x10U

#define BUSY     (1U << 16)
#define SEQUENCE (1U << 7)
#define WIDTH    (1U << 6)
#define PROTECT  (1U << 4)
#define LOCK     (1U << 31)
#define START    (1U << 16)
#define WIDTH_32 (2U << 8)

#define ERASE_READS   5000U
#define PROGRAM_READS 20U
#define BAD_CELL      0x1234U

struct flash_model flash_model;
uint8_t flash_model_memory[FLASH_MODEL_BYTES];

static uint32_t status, control;
static unsigned keys;
static bool is_shut; /* a wrong key: until the reset */
static uint64_t busy_until;

static void reset(void)
{
    flash_model = (struct flash_model){0};
    status = 0;
    control = LOCK;
    keys = 0;
    is_shut = false;
    busy_until = 0;
}

void flash_model_blank(void)
{
    memset(flash_model_memory, 0xFF, sizeof flash_model_memory);
}

bool flash_model_is_locked(void)
{
    return (control & LOCK) != 0;
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
        return status | (is_busy() ? BUSY : 0);
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

static void start_erase(void)
{
    const uint32_t sector = control >> 3 & 15U;

    if (flash_model.is_protected) {
        status |= PROTECT;
        return;
    }
    if ((control & 2U) == 0 || sector < FLASH_SECTOR_NUMBER || sector > FLASH_SECTOR_NUMBER + 1) {
        chip_model_break("a sector that is the program's is erased, or none");
        return;
    }
    memset(flash_model_memory + (size_t)(sector - FLASH_SECTOR_NUMBER) * FLASH_SECTOR_BYTES, 0xFF,
           FLASH_SECTOR_BYTES);
    flash_model.erased++;
    be_busy(ERASE_READS);
}

static void write_control(uint32_t value)
{
    if (is_busy())
        chip_model_break("the flash controller is written while it is busy");
    if ((control & LOCK) != 0) {
        if ((value & ~LOCK) != 0)
            chip_model_break("the flash controller is written while it is locked");
        return;
    }
    if ((value & 3U) != 0 && (value & 3U << 8) != WIDTH_32)
        chip_model_break("the flash is not written 32 bits at a time");
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
    else if (offset == SR)
        status &= ~value;
    else if (offset == CR)
        write_control(value);
}

const struct chip_block chip_flash = {0x40023C00U, 0x400U, read, write, reset};

/* ---- the memory itself ---- */

static uint32_t read_memory(uint32_t offset)
{
    uint32_t word;

    memcpy(&word, flash_model_memory + offset, sizeof word);
    return word;
}

/* Bits only go from 1 to 0. */
static void write_memory(uint32_t offset, uint32_t value)
{
    uint32_t word = read_memory(offset) & value;

    if (is_busy())
        chip_model_break("the flash is programmed while it is busy");
    if (flash_model.is_protected || (control & (LOCK | 1U)) != 1U || (status & 0xF2U) != 0) {
        status |= flash_model.is_protected ? PROTECT : SEQUENCE;
        return;
    }
    if ((control & 3U << 8) != WIDTH_32) {
        status |= WIDTH;
        return;
    }
    if (flash_model.has_bad_cell && offset == BAD_CELL)
        word |= 1U;
    memcpy(flash_model_memory + offset, &word, sizeof word);
    flash_model.programmed++;
    be_busy(PROGRAM_READS);
}

static void reset_memory(void)
{
    /* Power-off does not change it. */
}

const struct chip_block chip_flash_memory = {FLASH_SECTOR_ADDRESS, FLASH_MODEL_BYTES, read_memory,
                                             write_memory, reset_memory};
