/*
 * hal/motor.h of a drive's board: torque by the widths of pulses, an encoder at a timer, limit and
 * home switches. A step of the loops is one of the timer of the control cycle.
 */
#ifndef TAKT_STM32_SERVO_MOTOR_H
#define TAKT_STM32_SERVO_MOTOR_H

#include "hal/motor.h"
#include "stm32/gpio.h"
#include "stm32/quadrature.h"

struct servo_motor_config {
    uint32_t timer_hz;      /* of the timers on APB2 */
    uint32_t pulses_hz;     /* of the torque's pulses */
    double whole_mm_s2;     /* what the axis is accelerated by with the widest ones */
    double encoder_step_mm; /* the axis's way of a count */
    struct gpio_pin switches[MOTOR_INPUTS]; /* closed to ground, open when active */
};

/* Private. */
struct servo_motor {
    struct servo_motor_config config;
    struct quadrature encoder;
    double counts_per_mm_s2; /* of a pulse */
    int32_t whole_counts;
    int64_t counts, counts_before; /* of the encoder: now, and a step before */
    bool is_late;
    bool is_armed;
    struct motor_sense sense;
};

/* Its pins are set. The torque is 0, and not armed. */
void takt_servo_motor_open(struct servo_motor *motor, const struct servo_motor_config *config);

/* motor must stay. turn waits for the timer. */
struct motor_port takt_servo_motor_get_port(struct servo_motor *motor);

/* The drive wants torque. */
void takt_servo_motor_arm(struct servo_motor *motor, bool on);

/* The power stage has taken it away since. */
bool takt_servo_motor_has_failed(const struct servo_motor *motor);

/* A step has not ended before the timer's; told once. */
bool takt_servo_motor_take_late(struct servo_motor *motor);

#endif
