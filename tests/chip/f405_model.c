/* The parts of an STM32F405 that its drivers touch. */
#include "chip_model.h"
#include "stm32f405/usart_registers.h"
#include "usart_model.h"

const struct chip_block *const chip_blocks[] = {
    &chip_can,    &chip_clocks, &chip_power,   &chip_flash,  &chip_flash_memory,
    &chip_usart2, &chip_gpio_a, &chip_gpio_b,  &chip_gpio_c, &chip_tim1,
    &chip_tim2,   &chip_tim3,   &chip_watchdog};
const size_t chip_blocks_count = sizeof chip_blocks / sizeof chip_blocks[0];

const uint32_t usart_model_read_clears =
    USART_SR_RECEIVED | USART_SR_OVERRUN | USART_SR_NOISE | USART_SR_FRAMING | USART_SR_PARITY;
