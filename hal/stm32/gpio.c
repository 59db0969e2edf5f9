#include "stm32/gpio.h"

#include "chip/peripherals.h"
#include "stm32/chip.h"

#define GPIO_STRIDE 0x400U

#define GPIO_MODER   0x00U
#define GPIO_OSPEEDR 0x08U
#define GPIO_PUPDR   0x0CU
#define GPIO_IDR     0x10U
#define GPIO_ODR     0x14U
#define GPIO_BSRR    0x18U
#define GPIO_AFR     0x20U

enum mode { MODE_INPUT, MODE_OUTPUT, MODE_FUNCTION };
enum pull { PULL_NONE, PULL_UP };

#define SPEED_HIGH 2U

static uint32_t address_of(enum gpio_port port, uint32_t offset)
{
    return GPIO_BASE + GPIO_STRIDE * (uint32_t)port + offset;
}

/* Two bits a pin. */
static void set_pair(struct gpio_pin pin, uint32_t offset, uint32_t value)
{
    const unsigned shift = 2U * pin.number;

    chip_change(address_of(pin.port, offset), 3U << shift, value << shift);
}

static void set_mode(struct gpio_pin pin, enum mode mode, enum pull pull)
{
    chip_change(GPIO_CLOCKS, 0, 1U << pin.port);
    /* The clock of a port is there two of its cycles later: reading back waits for it. */
    (void)takt_chip_read(GPIO_CLOCKS);
    set_pair(pin, GPIO_PUPDR, pull);
    set_pair(pin, GPIO_OSPEEDR, SPEED_HIGH);
    set_pair(pin, GPIO_MODER, mode);
}

uint32_t takt_gpio_get_output_register(enum gpio_port port)
{
    return address_of(port, GPIO_ODR);
}

void takt_gpio_set_output(struct gpio_pin pin)
{
    chip_change(GPIO_CLOCKS, 0, 1U << pin.port);
    takt_gpio_write(pin, false);
    set_mode(pin, MODE_OUTPUT, PULL_NONE);
}

void takt_gpio_set_input(struct gpio_pin pin, bool pulled_up)
{
    set_mode(pin, MODE_INPUT, pulled_up ? PULL_UP : PULL_NONE);
}

void takt_gpio_set_function(struct gpio_pin pin, unsigned function)
{
    const unsigned shift = 4U * (pin.number % 8U);
    const uint32_t offset = GPIO_AFR + 4U * (pin.number / 8U);

    chip_change(GPIO_CLOCKS, 0, 1U << pin.port);
    chip_change(address_of(pin.port, offset), 15U << shift, function << shift);
    set_mode(pin, MODE_FUNCTION, PULL_UP);
}

void takt_gpio_write(struct gpio_pin pin, bool high)
{
    takt_chip_write(address_of(pin.port, GPIO_BSRR), 1U << (pin.number + (high ? 0U : 16U)));
}

bool takt_gpio_read(struct gpio_pin pin)
{
    return (takt_chip_read(address_of(pin.port, GPIO_IDR)) >> pin.number & 1U) != 0;
}
