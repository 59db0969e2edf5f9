/*
 * What the start has found, and which of it forbids to move.
 */
#ifndef TAKT_STM32_FINDINGS_H
#define TAKT_STM32_FINDINGS_H

#include "base/error.h"
#include "stm32/can_controller.h"
#include "stm32/clock.h"
#include "stm32/crash.h"

#include <stdbool.h>
#include <stdint.h>

struct findings {
    bool has_crashed; /* the last run ended so */
    struct crash_record crash;
    bool was_bitten;            /* by the watchdog */
    struct diagnostic image;    /* TAKT_OK: it is sound */
    struct diagnostic settings; /* TAKT_OK: they are there and right */
    bool needs_can;             /* the machine has drives on it */
    enum clock_source clock;
    uint32_t can_impossible; /* a bit rate that the controller cannot make; 0: none */
    enum can_state can;
    bool needs_steps;
    bool has_steps; /* its cycle can be put into slots */
};

/*
 * The problems one by one, the gravest first: *at begins at 0 and belongs to this function. False:
 * there is no other. None at all: the machine may move.
 */
bool takt_findings_next(const struct findings *found, unsigned *at, struct diagnostic *problem);

#endif
