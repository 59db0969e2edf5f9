/* The independent watchdog. */
#include "chip/peripherals.h"
#include "chip_model.h"
#include "flash_model.h"

static bool runs, may_write, is_stuck;
static uint32_t prescaler, reload, longest_ms;
static unsigned fed;
static uint64_t taken_at;

static void reset_watchdog(void)
{
    runs = may_write = is_stuck = false;
    prescaler = 0;
    reload = 0xFFF;
    longest_ms = 0;
    fed = 0;
    taken_at = 0;
}

static uint32_t read_watchdog(uint32_t offset)
{
    const bool busy = is_stuck || chip_model_reads() < taken_at;

    return offset == 0xCU && busy ? 3U : 0;
}

static void write_watchdog(uint32_t offset, uint32_t value)
{
    if (offset == 0) {
        runs = runs || value == 0xCCCCU;
        may_write = value == 0x5555U;
        fed += value == 0xAAAAU;
        return;
    }
    if (!may_write)
        chip_model_break("the watchdog's time is written without its key");
    if (chip_model_reads() < taken_at - (taken_at > 0))
        chip_model_break("the watchdog's time is written while it takes over the last one");
    if (offset == 4U)
        prescaler = value;
    else if (offset == 8U)
        reload = value;
    if (offset == 8U) {
        taken_at = chip_model_reads() + 100U;
        longest_ms = watchdog_model_ms() > longest_ms ? watchdog_model_ms() : longest_ms;
    }
}

const struct chip_block chip_watchdog = {WATCHDOG, 0x400U, read_watchdog, write_watchdog,
                                         reset_watchdog};

/* 4, 8, ... 256 clocks of 32 kHz a count. */
uint32_t watchdog_model_ms(void)
{
    return runs ? (reload + 1U) * (4U << prescaler) / 32U : 0;
}

uint32_t watchdog_model_longest_ms(void)
{
    return longest_ms;
}

unsigned watchdog_model_fed(void)
{
    return fed;
}

void watchdog_model_stick(void)
{
    is_stuck = true;
}
