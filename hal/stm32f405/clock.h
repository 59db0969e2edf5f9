/*
 * The chip's clock: 168 MHz out of the crystal, or of the internal oscillator when the crystal does not start. No wait is
 * without end, so the chip always comes up and can say what is wrong.
 */
#ifndef TAKT_STM32F405_CLOCK_H
#define TAKT_STM32F405_CLOCK_H

#include <stdbool.h>
#include <stdint.h>

enum clock_source {
    CLOCK_CRYSTAL,  /* as intended */
    CLOCK_INTERNAL, /* 168 MHz, good to 1 %: enough for serial lines, not for a CAN bus */
    CLOCK_SLOW      /* 16 MHz of the internal oscillator: the PLL does not lock */
};

struct clock {
    enum clock_source source;
    uint32_t core_hz;
    uint32_t bus1_hz, bus2_hz;     /* of the peripherals on APB1 and APB2 */
    uint32_t timer1_hz, timer2_hz; /* of the timers there */
};

/* Crystals that make exactly 168 MHz: whole MHz. */
#define CLOCK_CRYSTAL_MIN_HZ 4000000U
#define CLOCK_CRYSTAL_MAX_HZ 26000000U

/* To be called once, at the start, while the chip runs on its internal oscillator. */
void clock_start(struct clock *clock, uint32_t crystal_hz);

#endif
