/*
 * A serial line, with the driver of an RS-485 transceiver if it has one.
 *
 *     takt_usart_send      takes a reply that stays where it is until it has gone
 *     takt_usart_poll      begins to send it once the line has been silent for the gap
 *     takt_usart_interrupt byte by byte; after the last bit the transceiver listens again
 *
 * While it sends it does not listen: a transceiver whose receiver is always on would let it hear
 * itself.
 */
#ifndef TAKT_STM32_USART_H
#define TAKT_STM32_USART_H

#include "stm32/gpio.h"

#include <stddef.h>

/* Longest frame of Modbus RTU; also the room of a log line's end. */
#define USART_SEND_MAX 256

enum usart_parity { USART_PARITY_NONE, USART_PARITY_EVEN, USART_PARITY_ODD };

struct usart_config {
    uint32_t base;     /* USART_USART1, ... */
    uint32_t clock_hz; /* of its bus */
    uint32_t bauds;
    enum usart_parity parity;
    bool has_driver; /* an RS-485 transceiver, whose driver is enabled by: */
    struct gpio_pin driver;
    uint32_t gap_us; /* silence before a reply; 0: none */
    /* A byte has come, at a time of takt_usart_interrupt. */
    void (*take)(void *context, uint8_t byte, uint32_t now_us);
    void *context; /* the caller's */
};

/* They wrap. */
struct usart_counts {
    uint32_t received, sent;
    uint32_t damaged; /* parity, framing or noise: the byte is dropped */
    uint32_t overruns;
    uint32_t lost; /* to be sent while something else was */
};

/* Private. */
struct usart {
    struct usart_config config;
    volatile bool sending, waiting; /* waiting: for the gap, with something to send */
    const uint8_t *byte;            /* the caller's */
    size_t length;
    volatile size_t at;
    volatile uint32_t heard_us; /* when the last byte came */
    struct usart_counts counts;
};

/* Its pins have been set and its clock is on. False: the clock gives no such rate within 2 %. */
bool takt_usart_open(struct usart *u, const struct usart_config *config);

/*
 * byte: not touched until takt_usart_is_idle. False: something is being sent, or it is too long;
 * nothing is sent of it.
 */
bool takt_usart_send(struct usart *u, const uint8_t *byte, size_t length);

/* Nothing is being sent, or waits to be. */
bool takt_usart_is_idle(const struct usart *u);

/* As often as there is time. */
void takt_usart_poll(struct usart *u, uint32_t now_us);

void takt_usart_interrupt(struct usart *u, uint32_t now_us);

/* Sends what is left and a text without interrupts, waiting: for a chip that is about to stop. */
void takt_usart_shout(struct usart *u, const char *text);

#endif
