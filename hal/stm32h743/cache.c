/*
 * The core's caches (ARMv7-M Architecture Reference Manual, B2.2 and B3.2): both are on from the
 * start. 16 KiB of data in 4 ways of lines of 32 bytes.
 */
#include "port/cortex_m.h"
#include "port/startup.h"
#include "stm32h743/peripherals.h"

#define LINE 32U
#define SETS 128U
#define WAYS 4U

#define CCR     *cortex_register(0xE000ED14U)
#define ICIALLU *cortex_register(0xE000EF50U)
#define DCIMVAC *cortex_register(0xE000EF5CU)
#define DCISW   *cortex_register(0xE000EF60U)
#define DCCMVAC *cortex_register(0xE000EF68U)

#define CCR_IGNORE_BUS_FAULTS (1U << 8) /* of handlers that nothing interrupts */
#define CCR_CACHES            (3U << 16)

void takt_peripherals_order(void)
{
    __asm volatile("dsb\n\tisb" ::: "memory");
}

/* What a cache holds at reset is not known. */
void takt_port_begin(void)
{
    ICIALLU = 0;
    for (uint32_t set = 0; set < SETS; set++) {
        for (uint32_t way = 0; way < WAYS; way++)
            DCISW = way << 30 | set << 5;
    }
    takt_peripherals_order();
    CCR |= CCR_CACHES;
    takt_peripherals_order();
}

void peripherals_write_back(const void *memory, size_t bytes)
{
    const uint32_t begin = (uint32_t)(uintptr_t)memory & ~(LINE - 1U);
    const uint32_t end = (uint32_t)(uintptr_t)memory + bytes;

    takt_peripherals_order();
    for (uint32_t at = begin; at < end; at += LINE)
        DCCMVAC = at;
    takt_peripherals_order();
}

void takt_peripherals_forget(uint32_t address, uint32_t bytes)
{
    takt_peripherals_order();
    for (uint32_t at = address & ~(LINE - 1U); at < address + bytes; at += LINE)
        DCIMVAC = at;
    takt_peripherals_order();
}

void takt_peripherals_touch(uint32_t address)
{
    __asm volatile("cpsid f" ::: "memory");
    CCR |= CCR_IGNORE_BUS_FAULTS;
    takt_peripherals_order();
    (void)*(volatile const uint32_t *)(uintptr_t)address;
    takt_peripherals_order();
    CCR &= ~CCR_IGNORE_BUS_FAULTS;
    __asm volatile("cpsie f" ::: "memory");
}
