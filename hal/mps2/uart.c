#include "mps2/uart.h"

#include "mps2/board.h"
#include "port/cortex_m.h"

#include <string.h>

#define REGISTER(uart, offset) *cortex_register(0x40004000U + 0x1000U * (uart) + (offset))
#define DATA(uart)             REGISTER(uart, 0x00U)
#define STATE(uart)            REGISTER(uart, 0x04U)
#define CONTROL(uart)          REGISTER(uart, 0x08U)
#define INTERRUPT(uart)        REGISTER(uart, 0x0CU)
#define DIVIDER(uart)          REGISTER(uart, 0x10U)

#define STATE_OUT_FULL 1U
#define STATE_IN_FULL  2U

#define CONTROL_ALL 0xFU /* both directions, with interrupts */

#define INTERRUPT_OUT 1U
#define INTERRUPT_IN  2U

/* The least there is: QEMU does not keep to rates. */
#define DIVIDER_LEAST 16U

static struct uart *uarts[UART_COUNT];

/* Interrupt numbers: in before out, pair by pair. */
static unsigned in_interrupt(unsigned number)
{
    static const uint8_t first[UART_COUNT] = {0, 2, 4, 18};

    return first[number];
}

void takt_uart_open(struct uart *uart, unsigned number, void (*take)(void *context, uint8_t byte),
                    void *context)
{
    memset(uart, 0, sizeof *uart);
    uart->number = number;
    uart->take = take;
    uart->context = context;
    uarts[number] = uart;
    DIVIDER(number) = DIVIDER_LEAST;
    CONTROL(number) = CONTROL_ALL;
    for (unsigned i = 0; i < 2; i++) {
        cortex_set_priority(in_interrupt(number) + i, BOARD_PRIORITY_UART);
        cortex_enable_interrupt(in_interrupt(number) + i);
    }
}

/* As many as the UART takes, which is one. */
static void feed(struct uart *uart)
{
    while (uart->sent != uart->written && (STATE(uart->number) & STATE_OUT_FULL) == 0) {
        DATA(uart->number) = uart->out[uart->sent % UART_OUT_MAX];
        uart->sent++;
    }
}

bool takt_uart_send(struct uart *uart, const void *bytes, size_t size)
{
    const uint8_t *from = bytes;
    const uint32_t written = uart->written;

    if (size > UART_OUT_MAX - (written - uart->sent))
        return false;
    for (size_t i = 0; i < size; i++)
        uart->out[(written + i) % UART_OUT_MAX] = from[i];
    uart->written = written + (uint32_t)size;
    board_raise(in_interrupt(uart->number) + 1U); /* the first byte goes from there, too */
    return true;
}

bool takt_uart_is_idle(const struct uart *uart)
{
    return uart->sent == uart->written;
}

static void receive(unsigned number)
{
    struct uart *uart = uarts[number];

    INTERRUPT(number) = INTERRUPT_IN;
    while ((STATE(number) & STATE_IN_FULL) != 0) {
        const uint8_t byte = (uint8_t)DATA(number);

        if (uart->take != NULL)
            uart->take(uart->context, byte);
    }
}

static void send(unsigned number)
{
    INTERRUPT(number) = INTERRUPT_OUT;
    feed(uarts[number]);
}

void takt_uart_0_receive(void)
{
    receive(0);
}

void takt_uart_0_send(void)
{
    send(0);
}

void takt_uart_1_receive(void)
{
    receive(1);
}

void takt_uart_1_send(void)
{
    send(1);
}

void takt_uart_2_receive(void)
{
    receive(2);
}

void takt_uart_2_send(void)
{
    send(2);
}

void takt_uart_3_receive(void)
{
    receive(3);
}

void takt_uart_3_send(void)
{
    send(3);
}
