/*
 * A chip as far as its drivers touch it (f405_model.c, h743_model.c): registers that behave as the
 * reference manual says, so that the drivers run on the host as they are. It links in place of
 * hal/stm32/chip_memory.c.
 *
 * Time is the number of reads: what the hardware needs time for is there a number of reads later.
 */
#ifndef TAKT_TESTS_CHIP_MODEL_H
#define TAKT_TESTS_CHIP_MODEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Everything as after a reset of a healthy chip with a crystal. The flash keeps its contents. */
void chip_model_reset(void);

/* Rules of the manual that have been broken since the reset; NULL: none. The first. */
const char *chip_model_broken(void);

/* Reads of registers since the reset. */
uint64_t chip_model_reads(void);

/* Depth of takt_chip_lock. */
int chip_model_locks(void);

/* For the models of the peripherals. */
void chip_model_break(const char *rule);

struct chip_block {
    uint32_t base, size;
    uint32_t (*read)(uint32_t offset);
    void (*write)(uint32_t offset, uint32_t value);
    void (*reset)(void);
};

/* Blocks of the chip that is modelled. */
extern const struct chip_block *const chip_blocks[];
extern const size_t chip_blocks_count;

extern const struct chip_block chip_can, chip_can_memory, chip_clocks, chip_power, chip_flash,
    chip_flash_memory, chip_usart2, chip_gpio_a, chip_gpio_b, chip_gpio_c, chip_watchdog, chip_tim1,
    chip_tim2, chip_tim3;

#endif
