/* The clock tree, the regulator and the flash's wait states. */
#ifndef TAKT_TESTS_CLOCK_MODEL_H
#define TAKT_TESTS_CLOCK_MODEL_H

#include <stdbool.h>
#include <stdint.h>

/* What the board is like; set after chip_model_reset. */
struct clock_model {
    uint32_t crystal_hz; /* 0: there is none, it never starts */
    bool pll_locks;
    bool switches; /* the core takes the clock it is told to */
    bool is_dead;  /* every register reads 0, as in an emulator without a model of them */
};

extern struct clock_model clock_model;

/* Clocks of the core and of APB1, as the registers now say. */
uint32_t clock_model_core_hz(void);
uint32_t clock_model_bus1_hz(void);
/* Clock of the CAN controller, where it has one of its own; 0: it stands still. */
uint32_t clock_model_can_hz(void);

/* The register of the wait states, which the flash's model has among its own. */
uint32_t clock_model_read_acr(void);
void clock_model_write_acr(uint32_t value);

#endif
