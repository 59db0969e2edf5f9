/*
 * The board: which pin is what, and who may interrupt whom. README.md has the same as tables, with
 * the wiring.
 */
#ifndef TAKT_STM32H743_BOARD_H
#define TAKT_STM32H743_BOARD_H

#include "stm32/gpio.h"

#include <stdint.h>

/* The crystal of the board. A build may have another: even or a multiple of 5, in MHz, 4 to 48. */
#ifndef BOARD_CRYSTAL_HZ
#define BOARD_CRYSTAL_HZ 25000000U
#endif

/* The panel's line: Modbus RTU. */
#define BOARD_PANEL_BAUDS 115200U
#define BOARD_PANEL_BITS  11U /* start, 8, even parity, stop */
#define BOARD_PANEL_UNIT  1U
#define BOARD_LOG_BAUDS   115200U

/*
 * The silence that ends a frame on the panel's line, and the clock of TIM2 and TIM5. An emulator
 * leaves gaps on its serial lines as it likes, and its timers have a clock of their own: it gets an
 * image with others.
 */
#ifndef BOARD_TIMER_HZ
#define BOARD_TIMER_HZ 0U /* that of the bus they are on */
#endif
#ifndef BOARD_PANEL_GAP_US
#define BOARD_PANEL_GAP_US takt_modbus_rtu_gap_us(BOARD_PANEL_BAUDS, BOARD_PANEL_BITS)
#endif

#define BOARD_USART_FUNCTION 7U
#define BOARD_CAN_FUNCTION   9U

static const struct gpio_pin board_log_tx = {GPIO_A, 9}, board_log_rx = {GPIO_A, 10};
static const struct gpio_pin board_panel_tx = {GPIO_A, 2}, board_panel_rx = {GPIO_A, 3},
                             board_panel_driver = {GPIO_A, 1};
static const struct gpio_pin board_can_rx = {GPIO_B, 8}, board_can_tx = {GPIO_B, 9};

/* Closes to ground on contact. Opens when pressed: a broken wire is a pressed button. */
static const struct gpio_pin board_probe = {GPIO_B, 0}, board_emergency = {GPIO_B, 1};

static const struct gpio_pin board_spindle = {GPIO_B, 12}, board_flood = {GPIO_B, 13},
                             board_mist = {GPIO_B, 14};

/* Steps of X Y Z A B C on pins 0 to 5 of this port, directions on 8 to 13. */
#define BOARD_STEP_PORT     GPIO_C
#define BOARD_STEP_PIN      0U
#define BOARD_DIRECTION_PIN 8U

/* Interrupts by their numbers in RM0433, 20.1.2. */
enum board_interrupt {
    BOARD_CAN_SENT = 19,     /* the first line of FDCAN1 */
    BOARD_CAN_RECEIVED = 21, /* its second line */
    BOARD_CYCLE = 28,        /* TIM2 */
    BOARD_LOG = 37,
    BOARD_PANEL = 38,
    BOARD_INTERRUPTS = 150
};

/* The upper four bits count; the lowest number is the most urgent. */
#define BOARD_PRIORITY_CAN   0x20U
#define BOARD_PRIORITY_PANEL 0x40U
#define BOARD_PRIORITY_LOG   0x60U
#define BOARD_PRIORITY_CYCLE 0x80U

/* The control cycle must be heard of within this time. */
#define BOARD_WATCHDOG_MS 250U

#endif
