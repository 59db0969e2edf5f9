#include "usart_model.h"

#include "chip/peripherals.h"
#include "chip/usart_registers.h"
#include "chip_model.h"

#include <string.h>

#define DRIVER_PIN 1U
#define CLEAR      0x20U /* where later chips have it */

struct usart_model usart_model;

static uint32_t status, divider, control[3], received;
static bool has_waiting, has_shifting; /* a byte behind the one being sent; one being sent */
static uint8_t waiting, shifting;

static void reset(void)
{
    memset(&usart_model, 0, sizeof usart_model);
    status = USART_SR_SENT | USART_SR_ROOM;
    divider = received = 0;
    memset(control, 0, sizeof control);
    has_waiting = has_shifting = false;
}

static bool is_control(uint32_t offset)
{
    return offset - USART_CR1 <= USART_CR3 - USART_CR1;
}

static uint32_t read(uint32_t offset)
{
    switch (offset) {
    case USART_SR:
        return usart_model.is_stuck ? status & ~(USART_SR_ROOM | USART_SR_SENT) : status;
    case USART_RDR:
        status &= ~usart_model_read_clears;
        return received;
    case USART_BRR:
        return divider;
    default:
        return is_control(offset) ? control[(offset - USART_CR1) / 4] : 0;
    }
}

static void load(uint8_t byte)
{
    status &= ~USART_SR_SENT;
    if (!has_shifting) {
        shifting = byte;
        has_shifting = true;
        return;
    }
    if (has_waiting)
        chip_model_break("a byte is written before the one before it has gone");
    waiting = byte;
    has_waiting = true;
    status &= ~USART_SR_ROOM;
}

static void write(uint32_t offset, uint32_t value)
{
    if (offset == USART_TDR) {
        if ((control[0] & USART_CR1_ON) == 0)
            chip_model_break("a byte is sent while the USART is off");
        load((uint8_t)value);
    } else if (offset == USART_BRR) {
        if ((control[0] & USART_CR1_ON) != 0)
            chip_model_break("the rate is changed while the USART is on");
        divider = value;
    } else if (offset == CLEAR) {
        status &= ~value;
    } else if (is_control(offset)) {
        control[(offset - USART_CR1) / 4] = value;
    }
}

const struct chip_block chip_usart2 = {USART_USART2, 0x400U, read, write, reset};

void usart_model_hear(uint8_t byte, uint32_t errors)
{
    status |= errors;
    if ((status & USART_SR_RECEIVED) != 0) {
        status |= USART_SR_OVERRUN;
        return;
    }
    received = byte;
    status |= USART_SR_RECEIVED;
}

void usart_model_shift(void)
{
    if (!has_shifting)
        return;
    if (usart_model.count < USART_MODEL_SENT_MAX) {
        usart_model.sent[usart_model.count] = shifting;
        usart_model.driven[usart_model.count] = gpio_model_pin(DRIVER_PIN);
        usart_model.count++;
    }
    has_shifting = has_waiting;
    shifting = waiting;
    has_waiting = false;
    status |= USART_SR_ROOM | (has_shifting ? 0 : USART_SR_SENT);
}

bool usart_model_asks(void)
{
    const uint32_t on = control[0];

    return ((on & USART_CR1_ON_RECEIVE) != 0 &&
            (status & (USART_SR_RECEIVED | USART_SR_OVERRUN)) != 0) ||
           ((on & USART_CR1_ON_ROOM) != 0 && (status & USART_SR_ROOM) != 0) ||
           ((on & USART_CR1_ON_SENT) != 0 && (status & USART_SR_SENT) != 0);
}

uint32_t usart_model_divider(void)
{
    return divider;
}

uint32_t usart_model_control(void)
{
    return control[0];
}

/* ---- port A ---- */

static uint32_t gpio[10], inputs;

static void reset_gpio(void)
{
    memset(gpio, 0, sizeof gpio);
    inputs = 0;
}

static uint32_t read_gpio(uint32_t offset)
{
    if (offset == 0x10U)
        return inputs;
    return offset < sizeof gpio ? gpio[offset / 4] : 0;
}

static void write_gpio(uint32_t offset, uint32_t value)
{
    if (offset == 0x18U)
        gpio[5] = (gpio[5] & ~(value >> 16)) | (value & 0xFFFFU);
    else if (offset < sizeof gpio)
        gpio[offset / 4] = value;
}

const struct chip_block chip_gpio_a = {GPIO_BASE, 0x400U, read_gpio, write_gpio, reset_gpio};

bool gpio_model_pin(unsigned number)
{
    return (gpio[5] >> number & 1U) != 0;
}

bool gpio_model_is_output(unsigned number)
{
    return (gpio[0] >> 2 * number & 3U) == 1U;
}

void gpio_model_set_input(unsigned number, bool high)
{
    inputs = (inputs & ~(1U << number)) | (uint32_t)high << number;
}
