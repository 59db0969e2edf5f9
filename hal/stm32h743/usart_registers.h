/*
 * Registers of a USART, offsets from its base (RM0433, 48.7).
 */
#ifndef TAKT_STM32H743_USART_REGISTERS_H
#define TAKT_STM32H743_USART_REGISTERS_H

#include "stm32/chip.h"

#define USART_USART1 0x40011000U
#define USART_USART2 0x40004400U

#define USART_CR1 0x00U
#define USART_CR2 0x04U
#define USART_CR3 0x08U
#define USART_BRR 0x0CU
#define USART_SR  0x1CU /* ISR */
#define USART_ICR 0x20U
#define USART_RDR 0x24U
#define USART_TDR 0x28U

#define USART_SR_PARITY   (1U << 0)
#define USART_SR_FRAMING  (1U << 1)
#define USART_SR_NOISE    (1U << 2)
#define USART_SR_OVERRUN  (1U << 3)
#define USART_SR_RECEIVED (1U << 5)
#define USART_SR_SENT     (1U << 6) /* the last bit has left the pin */
#define USART_SR_ROOM     (1U << 7)

#define USART_CR1_ON         (1U << 0)
#define USART_CR1_RECEIVER   (1U << 2)
#define USART_CR1_SENDER     (1U << 3)
#define USART_CR1_ON_RECEIVE (1U << 5) /* interrupts */
#define USART_CR1_ON_SENT    (1U << 6)
#define USART_CR1_ON_ROOM    (1U << 7)
#define USART_CR1_ODD        (1U << 9)
#define USART_CR1_PARITY     (1U << 10)
#define USART_CR1_9_BITS     (1U << 12) /* the parity's included */

/* The errors in a status that has been read. */
static inline void usart_clear_errors(uint32_t base, uint32_t status)
{
    takt_chip_write(base + USART_ICR, status & (USART_SR_PARITY | USART_SR_FRAMING |
                                                USART_SR_NOISE | USART_SR_OVERRUN));
}

#endif
