/*
 * The timers of a drive: pulses (TIM1), ticks (TIM2), encoder (TIM3); and the pins of ports B and
 * C.
 */
#ifndef TAKT_TESTS_TIMER_MODEL_H
#define TAKT_TESTS_TIMER_MODEL_H

#include <stdbool.h>
#include <stdint.h>

/*
 * What the pulses of the channels say: the part of the time that channel 1 is high, less that of
 * channel 2.
 */
double timer_model_get_torque(void);

/* The pin of the break is low. */
void timer_model_hold_break(bool low);

/* The encoder turns by this many edges of its tracks. */
void timer_model_turn(int32_t counts);

/* The index pulse rises and falls; the switch has an edge. */
void timer_model_pulse_index(void);
void timer_model_switch(bool high);

/* Called at every tick. */
void timer_model_set_tick(void (*call)(void *context), void *context);

/* A tick is there before anybody waits for it. */
void timer_model_hurry(void);

/* Sets a pin of port B or C. */
void timer_model_set_pin(char port, unsigned number, bool high);
/* An output of port C. */
bool timer_model_pin_is_high(unsigned number);

#endif
