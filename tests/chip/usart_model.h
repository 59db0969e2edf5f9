/* USART2 with its pins, and what is at the other end of the line. */
#ifndef TAKT_TESTS_USART_MODEL_H
#define TAKT_TESTS_USART_MODEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define USART_MODEL_SENT_MAX 512

/* What has left the pin, and how the driver's pin stood at each byte's last bit. */
struct usart_model {
    uint8_t sent[USART_MODEL_SENT_MAX];
    bool driven[USART_MODEL_SENT_MAX];
    size_t count;
    bool is_stuck; /* never has room */
};

extern struct usart_model usart_model;

/* Bits of the status that reading the data clears on this chip. */
extern const uint32_t usart_model_read_clears;

/* A byte comes, with bits of the status register for what is wrong with it. */
void usart_model_hear(uint8_t byte, uint32_t errors);
/* The time of a character goes by: what is in the shift register has left. */
void usart_model_shift(void);
/* The interrupt it now asks for. */
bool usart_model_asks(void);
uint32_t usart_model_divider(void);
uint32_t usart_model_control(void);

/* Pin number of port A: its output, if it is one. */
bool gpio_model_pin(unsigned number);
bool gpio_model_is_output(unsigned number);
void gpio_model_set_input(unsigned number, bool high);

#endif
