/* Registers as loads and stores: chip.h on the chip itself. */
#include "stm32/chip.h"

uint32_t takt_chip_read(uint32_t address)
{
    return *(volatile const uint32_t *)(uintptr_t)address;
}

void takt_chip_write(uint32_t address, uint32_t value)
{
    *(volatile uint32_t *)(uintptr_t)address = value;
}

uint32_t takt_chip_lock(void)
{
    uint32_t before;

    __asm volatile("mrs %0, primask\n\tcpsid i" : "=r"(before)::"memory");
    return before;
}

void takt_chip_unlock(uint32_t before)
{
    __asm volatile("msr primask, %0" ::"r"(before) : "memory");
}
