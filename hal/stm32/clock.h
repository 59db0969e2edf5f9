/*
 * The chip's clock: its full speed out of the crystal, or of the internal oscillator when the
 * crystal does not start. No wait is without end, so the chip always comes up and can say what is
 * wrong.
 */
#ifndef TAKT_STM32_CLOCK_H
#define TAKT_STM32_CLOCK_H

#include <stdbool.h>
#include <stdint.h>

enum clock_source {
    CLOCK_CRYSTAL,  /* as intended */
    CLOCK_INTERNAL, /* the full speed, good to 1 %: enough for serial lines, not for a CAN bus */
    CLOCK_SLOW      /* the internal oscillator alone: the PLL does not lock */
};

struct clock {
    enum clock_source source;
    uint32_t core_hz;
    uint32_t bus1_hz, bus2_hz;     /* of the peripherals on APB1 and APB2 */
    uint32_t timer1_hz, timer2_hz; /* of the timers there */
    uint32_t can_hz;
};

/* To be called once, at the start, while the chip runs on its internal oscillator. */
void takt_clock_start(struct clock *clock, uint32_t crystal_hz);

#endif
