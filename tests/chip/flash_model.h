/* The flash controller, sectors 10 and 11, and the independent watchdog. */
#ifndef TAKT_TESTS_FLASH_MODEL_H
#define TAKT_TESTS_FLASH_MODEL_H

#include <stdbool.h>
#include <stdint.h>

#define FLASH_MODEL_BYTES 0x40000U

/* Set after chip_model_reset. */
struct flash_model {
    bool is_protected; /* against writing */
    bool never_ends;   /* stays busy */
    bool has_bad_cell; /* one bit that cannot be cleared */
    unsigned erased, programmed;
};

extern struct flash_model flash_model;
extern uint8_t flash_model_memory[FLASH_MODEL_BYTES];

/* As delivered. */
void flash_model_blank(void);
bool flash_model_is_locked(void);

/* The time the watchdog now waits; 0: it does not run. The longest it has had. */
uint32_t watchdog_model_ms(void);
uint32_t watchdog_model_longest_ms(void);
unsigned watchdog_model_fed(void);
void watchdog_model_stick(void);

#endif
