/*
 * The CMSDK UARTs of the MPS2 boards (Arm Cortex-M System Design Kit, 4.3), by interrupt in both
 * directions. One byte each way is all they hold; QEMU makes the other end wait meanwhile, so
 * nothing is lost.
 */
#ifndef TAKT_MPS2_UART_H
#define TAKT_MPS2_UART_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define UART_COUNT 4

/*
 * Bytes that wait to be sent: a power of two. A cycle's frames (six drives: 22 bytes each of a PDO
 * and an SDO), a reply of Modbus (256), or the longest line of the log and some short ones; no
 * cycle begins before the last one's frames have gone.
 */
#define UART_OUT_MAX 512

struct uart {
    unsigned number;                           /* 0 ... UART_COUNT - 1 */
    void (*take)(void *context, uint8_t byte); /* from the interrupt; NULL: what comes is dropped */
    void *context;
    volatile uint32_t written, sent; /* bytes so far, wrapping */
    uint8_t out[UART_OUT_MAX];
};

/* It must not be moved. */
void takt_uart_open(struct uart *uart, unsigned number, void (*take)(void *context, uint8_t byte),
                    void *context);

/* Queues all of the bytes or, for want of room, none: false. From one level of interrupts alone. */
bool takt_uart_send(struct uart *uart, const void *bytes, size_t size);

/* Everything queued has gone. */
bool takt_uart_is_idle(const struct uart *uart);

#endif
