/*
 * The board of a drive: pins, and the axis that it moves. A drive's machine is what is built in
 * here; what its objects say is stored by 1010. hal/stm32f405/README.md has the same as tables.
 */
#ifndef TAKT_STM32DRIVE_DRIVE_BOARD_H
#define TAKT_STM32DRIVE_DRIVE_BOARD_H

#include "servo/servo.h"
#include "stm32/servo_motor.h"

/* Until LSS has given it another one; and the rate of its bus. */
#ifndef DRIVE_NODE
#define DRIVE_NODE 1U
#endif
#ifndef DRIVE_BITRATE
#define DRIVE_BITRATE 1000000U
#endif

#define DRIVE_PULSES_HZ 20000U

#define DRIVE_PWM_FUNCTION     1U /* TIM1 */
#define DRIVE_ENCODER_FUNCTION 2U /* TIM3 */

/* CAN as on the controller's board. */
static const struct gpio_pin drive_up = {GPIO_A, 8}, drive_down = {GPIO_A, 9},
                             drive_enable = {GPIO_A, 10}, drive_fails = {GPIO_B, 12};
static const struct gpio_pin drive_track_a = {GPIO_B, 4}, drive_track_b = {GPIO_B, 5},
                             drive_index = {GPIO_B, 0}, drive_home = {GPIO_B, 1};
static const struct gpio_pin drive_limit_low = {GPIO_C, 0}, drive_limit_high = {GPIO_C, 1};

/*
 * A motor of 400 W with 2500 lines on a screw of 10 mm: the axis of host/drives/README.md with the
 * encoder of a timer. The loops turn at 4 kHz, as that page's do.
 */
static const struct servo_config drive_config = {
    .node = DRIVE_NODE,
    .increments_per_mm = 1000,
    .following_error_window_mm = 2,
    .quick_stop_deceleration_mm_s2 = 2000,
    .loop = {.travel_per_revolution_mm = 10,
             .inertia_kg_m2 = 3e-4,
             .torque_max_nm = 3.8,
             .torque_rated_nm = 1.27,
             .encoder_counts_per_revolution = 10000,
             .loop_period_us = 250,
             .position_gain_per_s = 100,
             .velocity_feed_forward_ratio = 1,
             .velocity_bandwidth_hz = 100,
             .velocity_integral_time_s = 0.02},
};

#endif
