#include "stm32/watchdog.h"

#include "chip/peripherals.h"
#include "stm32/chip.h"

#define IWDG_KR  (WATCHDOG + 0x0U)
#define IWDG_PR  (WATCHDOG + 0x4U)
#define IWDG_RLR (WATCHDOG + 0x8U)
#define IWDG_SR  (WATCHDOG + 0xCU)

#define KEY_START  0xCCCCU
#define KEY_FEED   0xAAAAU
#define KEY_ACCESS 0x5555U

#define SR_BUSY 3U /* prescaler or reload being taken over */

/* 32 kHz / 64: 2 ms a count, 4096 of them. */
#define PRESCALER_64 4U
#define MS_PER_COUNT 2U

/*
 * Taking over lasts up to 5 of the watchdog's own clocks, 0.3 ms: some tens of thousands of reads.
 */
#define BUSY_READS 200000U

bool takt_watchdog_start(uint32_t ms)
{
    const uint32_t count = (ms + MS_PER_COUNT - 1U) / MS_PER_COUNT;
    bool good = count >= 1 && ms <= WATCHDOG_MS_MAX;

    takt_chip_write(IWDG_KR, KEY_START);
    good = chip_wait(IWDG_SR, SR_BUSY, 0, BUSY_READS) && good;
    if (good) {
        takt_chip_write(IWDG_KR, KEY_ACCESS);
        takt_chip_write(IWDG_PR, PRESCALER_64);
        takt_chip_write(IWDG_RLR, count - 1U);
        good = chip_wait(IWDG_SR, SR_BUSY, 0, BUSY_READS);
    }
    takt_watchdog_feed();
    return good;
}

void takt_watchdog_feed(void)
{
    takt_chip_write(IWDG_KR, KEY_FEED);
}
