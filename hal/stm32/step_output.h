/*
 * Step and direction pins: the slots of a cycle (step_slots.h) go to the port's output register by
 * direct memory access, one at every tick of TIM8, while the next cycle's are being made. Pulses
 * leave one cycle after they were queued. The port has no other outputs: its pins are written
 * together.
 */
#ifndef TAKT_STM32_STEP_OUTPUT_H
#define TAKT_STM32_STEP_OUTPUT_H

#include "stm32/gpio.h"
#include "stm32/step_slots.h"

/* Private. */
struct step_output {
    struct step_slots slots;
    /* One is being sent, the other one made: not in the core-coupled memory. */
    uint16_t levels[2][STEP_SLOTS_MAX];
    bool runs;
};

/* The port's pins, outputs and low. timer_hz: of the timers on APB2. False: no such cycle. */
bool takt_step_output_open(struct step_output *s, enum gpio_port port, uint32_t timer_hz,
                           uint32_t cycle_us);

/* For hal/step.h. No encoders. */
struct step_port takt_step_output_get_port(struct step_output *s);

/* At the start of every control cycle, and at its end. */
void takt_step_output_begin(struct step_output *s);
void takt_step_output_end(struct step_output *s);

#endif
