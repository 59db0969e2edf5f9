/*
 * Timers: microseconds that wrap (TIM5), and the interrupt of the control cycle (TIM2).
 */
#ifndef TAKT_STM32_TIMERS_H
#define TAKT_STM32_TIMERS_H

#include <stdbool.h>
#include <stdint.h>

/* timer_hz: of the timers on APB1, a multiple of 1 MHz. */
void takt_timers_start_clock(uint32_t timer_hz);
uint32_t takt_timers_now_us(void);

/* An interrupt every cycle_us, from now on. */
void takt_timers_start_cycle(uint32_t timer_hz, uint32_t cycle_us);

/* At the start of that interrupt. */
void takt_timers_take_cycle(void);

/* The next cycle is due already. */
bool takt_timers_cycle_is_due(void);

#endif
