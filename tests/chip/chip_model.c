#include "chip_model.h"

#include "stm32/chip.h"

#include <stdio.h>
#include <stdlib.h>

static const char *broken;
static uint64_t reads;
static int locks;

void chip_model_reset(void)
{
    broken = NULL;
    reads = 0;
    locks = 0;
    for (size_t i = 0; i < chip_blocks_count; i++)
        chip_blocks[i]->reset();
}

const char *chip_model_broken(void)
{
    return broken;
}

uint64_t chip_model_reads(void)
{
    return reads;
}

int chip_model_locks(void)
{
    return locks;
}

void chip_model_break(const char *rule)
{
    if (broken == NULL)
        broken = rule;
}

static const struct chip_block *find(uint32_t address)
{
    for (size_t i = 0; i < chip_blocks_count; i++) {
        if (address - chip_blocks[i]->base < chip_blocks[i]->size)
            return chip_blocks[i];
    }
    (void)fprintf(stderr, "no model of address %08x\n", (unsigned)address);
    abort();
}

uint32_t takt_chip_read(uint32_t address)
{
    const struct chip_block *block = find(address);

    reads++;
    if (address % 4 != 0)
        chip_model_break("a word is read at an address that is no multiple of 4");
    return block->read(address - block->base);
}

void takt_chip_write(uint32_t address, uint32_t value)
{
    const struct chip_block *block = find(address);

    if (address % 4 != 0)
        chip_model_break("a word is written at an address that is no multiple of 4");
    block->write(address - block->base, value);
}

uint32_t takt_chip_lock(void)
{
    return (uint32_t)locks++;
}

void takt_chip_unlock(uint32_t before)
{
    if ((uint32_t)--locks != before)
        chip_model_break("chip_unlock without its chip_lock");
}
