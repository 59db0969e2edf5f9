/*
 * The independent watchdog: its own oscillator of some 32 kHz (17 to 47), so times are nominal.
 * Once started only a reset stops it.
 */
#ifndef TAKT_STM32_WATCHDOG_H
#define TAKT_STM32_WATCHDOG_H

#include <stdbool.h>
#include <stdint.h>

#define WATCHDOG_MS_MAX 8192U

/*
 * Starts it, or gives it another time. ms: 1 ... WATCHDOG_MS_MAX. False: it does not take the time;
 * it runs all the same.
 */
bool takt_watchdog_start(uint32_t ms);

/* It must be heard within the time, else the chip is reset. */
void takt_watchdog_feed(void);

#endif
