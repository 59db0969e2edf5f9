/*
 * Pins.
 */
#ifndef TAKT_STM32_GPIO_H
#define TAKT_STM32_GPIO_H

#include <stdbool.h>
#include <stdint.h>

enum gpio_port { GPIO_A, GPIO_B, GPIO_C, GPIO_D };

struct gpio_pin {
    enum gpio_port port;
    uint8_t number; /* 0 ... 15 */
};

/* The levels of all pins of a port that are outputs: 16 bits. */
uint32_t takt_gpio_get_output_register(enum gpio_port port);

/* Pushes and pulls, starts low. */
void takt_gpio_set_output(struct gpio_pin pin);
/* pulled_up: an open contact reads true. */
void takt_gpio_set_input(struct gpio_pin pin, bool pulled_up);
/* Belongs to a peripheral, 0 ... 15 by the data sheet's table of alternate functions. */
void takt_gpio_set_function(struct gpio_pin pin, unsigned function);

void takt_gpio_write(struct gpio_pin pin, bool high);
bool takt_gpio_read(struct gpio_pin pin);

#endif
