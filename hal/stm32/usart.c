#include "stm32/usart.h"

#include "chip/usart_registers.h"
#include "stm32/chip.h"

#include <string.h>

/* Divider of a clock at 16 samples a bit. */
#define DIVIDER_MIN 16U
#define DIVIDER_MAX 0xFFFFU
#define ERROR_MAX   50U /* one part of this many: 2 % */

/* Steps at one time: the longest frame, and what comes meanwhile. */
#define SERVED_MAX (USART_SEND_MAX + 16U)

/* Reads of a register in which a character has left at 9600 baud, and more. */
#define CHARACTER_READS 300000U

static uint32_t address_of(const struct usart *u, uint32_t offset)
{
    return u->config.base + offset;
}

static void drive(const struct usart *u, bool on)
{
    if (u->config.has_driver)
        takt_gpio_write(u->config.driver, on);
}

static bool rate_is_possible(uint32_t clock_hz, uint32_t divider, uint32_t bauds)
{
    const uint32_t rate = clock_hz / divider;
    const uint32_t error = rate > bauds ? rate - bauds : bauds - rate;

    return divider >= DIVIDER_MIN && divider <= DIVIDER_MAX && error <= bauds / ERROR_MAX;
}

static uint32_t control_of(enum usart_parity parity)
{
    const uint32_t control = USART_CR1_RECEIVER | USART_CR1_SENDER | USART_CR1_ON_RECEIVE;

    if (parity == USART_PARITY_NONE)
        return control;
    return control | USART_CR1_PARITY | USART_CR1_9_BITS |
           (parity == USART_PARITY_ODD ? USART_CR1_ODD : 0);
}

bool takt_usart_open(struct usart *u, const struct usart_config *config)
{
    const uint32_t divider =
        config->bauds > 0 ? (config->clock_hz + config->bauds / 2) / config->bauds : 0;

    memset(u, 0, sizeof *u);
    u->config = *config;
    if (divider == 0 || !rate_is_possible(config->clock_hz, divider, config->bauds))
        return false;
    if (config->has_driver)
        takt_gpio_set_output(config->driver);
    takt_chip_write(address_of(u, USART_CR1), 0);
    takt_chip_write(address_of(u, USART_BRR), divider);
    takt_chip_write(address_of(u, USART_CR2), 0);
    takt_chip_write(address_of(u, USART_CR3), 0);
    takt_chip_write(address_of(u, USART_CR1), control_of(config->parity) | USART_CR1_ON);
    return true;
}

bool takt_usart_is_idle(const struct usart *u)
{
    return !u->sending && !u->waiting;
}

bool takt_usart_send(struct usart *u, const uint8_t *byte, size_t length)
{
    if (!takt_usart_is_idle(u) || length == 0 || length > USART_SEND_MAX) {
        u->counts.lost++;
        return false;
    }
    u->byte = byte;
    u->length = length;
    u->at = 0;
    u->waiting = true;
    return true;
}

static void begin(struct usart *u)
{
    u->waiting = false;
    u->sending = true;
    drive(u, true);
    chip_change(address_of(u, USART_CR1), USART_CR1_ON_SENT, USART_CR1_ON_ROOM);
}

/* The last byte has been handed over: its last bit is waited for. */
static void send_next(struct usart *u)
{
    takt_chip_write(address_of(u, USART_TDR), u->byte[u->at]);
    u->at++;
    u->counts.sent++;
    if (u->at == u->length)
        chip_change(address_of(u, USART_CR1), USART_CR1_ON_ROOM, USART_CR1_ON_SENT);
}

static void end(struct usart *u, uint32_t now_us)
{
    chip_change(address_of(u, USART_CR1), USART_CR1_ON_SENT, 0);
    drive(u, false);
    u->sending = false;
    u->heard_us = now_us;
}

/* What the status asks for, of sending. False: nothing. */
static bool go_on(struct usart *u, uint32_t status, uint32_t now_us)
{
    if (u->at < u->length && (status & USART_SR_ROOM) != 0)
        send_next(u);
    else if (u->at == u->length && (status & USART_SR_SENT) != 0)
        end(u, now_us);
    else
        return false;
    return true;
}

static void take_byte(struct usart *u, uint32_t status, uint32_t now_us)
{
    const uint8_t byte = (uint8_t)takt_chip_read(address_of(u, USART_RDR));

    usart_clear_errors(u->config.base, status);
    u->heard_us = now_us;
    if ((status & USART_SR_OVERRUN) != 0)
        u->counts.overruns++;
    if (u->sending)
        return;
    if ((status & (USART_SR_PARITY | USART_SR_FRAMING | USART_SR_NOISE)) != 0) {
        u->counts.damaged++;
        return;
    }
    u->counts.received++;
    u->config.take(u->config.context, byte, now_us);
}

/* Looks once. False: there was nothing to do. */
static bool serve(struct usart *u, uint32_t now_us)
{
    const uint32_t status = takt_chip_read(address_of(u, USART_SR));
    const bool came = (status & (USART_SR_RECEIVED | USART_SR_OVERRUN)) != 0;
    /* First: when the last bit has gone, what has come is no echo but the answer to it. */
    const bool went = u->sending && go_on(u, status, now_us);

    if (came)
        take_byte(u, status, now_us);
    return came || went;
}

/* More than one interrupt's work if there is: an emulator may tell of two bytes once. */
void takt_usart_interrupt(struct usart *u, uint32_t now_us)
{
    for (unsigned i = 0; i < SERVED_MAX && serve(u, now_us); i++) {
    }
}

/* An interrupt that does not come, as in an emulator that has none for sending, stops nothing. */
void takt_usart_poll(struct usart *u, uint32_t now_us)
{
    const uint32_t before = takt_chip_lock();

    if (u->waiting && now_us - u->heard_us >= u->config.gap_us)
        begin(u);
    takt_usart_interrupt(u, now_us);
    takt_chip_unlock(before);
}

static bool shout_byte(const struct usart *u, uint8_t byte)
{
    if (!chip_wait(address_of(u, USART_SR), USART_SR_ROOM, USART_SR_ROOM, CHARACTER_READS))
        return false;
    takt_chip_write(address_of(u, USART_TDR), byte);
    return true;
}

void takt_usart_shout(struct usart *u, const char *text)
{
    bool good = true;

    chip_change(address_of(u, USART_CR1), USART_CR1_ON_ROOM | USART_CR1_ON_SENT, 0);
    drive(u, true);
    while (good && u->at < u->length)
        good = shout_byte(u, u->byte[u->at++]);
    while (good && *text != '\0')
        good = shout_byte(u, (uint8_t)*text++);
    (void)chip_wait(address_of(u, USART_SR), USART_SR_SENT, USART_SR_SENT, CHARACTER_READS);
    drive(u, false);
    u->sending = false;
    u->waiting = false;
}
