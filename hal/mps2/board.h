/*
 * The MPS2 boards AN386 (Cortex-M4) and AN500 (Cortex-M7) as QEMU has them: who may interrupt whom.
 *
 *     UARTs        most urgent, a few instructions a byte
 *     SysTick      the control cycle
 *     background   main: reading, planning, the panel
 */
#ifndef TAKT_MPS2_BOARD_H
#define TAKT_MPS2_BOARD_H

#include "port/cortex_m.h"

#include <stdint.h>

#define BOARD_CLOCK_HZ 25000000U

#define BOARD_PRIORITY_UART  0x20U
#define BOARD_PRIORITY_CYCLE CORTEX_PRIORITY_CYCLE

/* Makes an interrupt pending. */
static inline void board_raise(unsigned interrupt)
{
    *cortex_register(0xE000EF00U) = interrupt; /* software trigger, ARMv7-M B3.2.26 */
}

/* Handlers, uart.c. */
void takt_uart_0_receive(void);
void takt_uart_0_send(void);
void takt_uart_1_receive(void);
void takt_uart_1_send(void);
void takt_uart_2_receive(void);
void takt_uart_2_send(void);
void takt_uart_3_receive(void);
void takt_uart_3_send(void);

#endif
