/*
 * The torque of a motor as the widths of pulses (TIM1): channel 1 is high for the part of the
 * torque upwards, channel 2 for that downwards; both are low without torque. What stands behind
 * them makes a current of it.
 *
 * Break: a power stage that fails pulls a pin low, and both channels are low at once, without the
 * processor, until they are armed again.
 */
#ifndef TAKT_STM32_PWM_H
#define TAKT_STM32_PWM_H

#include <stdbool.h>
#include <stdint.h>

/*
 * timer_hz: of the timers on APB2. Returns the counts of a pulse and its pause, which are those of
 * the whole torque.
 */
uint32_t takt_pwm_open(uint32_t timer_hz, uint32_t pulses_hz);

/* The channels lead to the pins, or they are low. Armed anew a break is forgotten. */
void takt_pwm_arm(bool on);

/* A break has been since they were armed. */
bool takt_pwm_is_broken(void);

/* From the next pulse on. counts: up, or if less than 0 down; at most those of the whole torque. */
void takt_pwm_set(int32_t counts);

#endif
