/*
 * What the chip does when it cannot go on: it keeps a record and starts anew. Drives notice by
 * themselves that nobody speaks to them any more (heartbeat), and the next start tells what
 * happened and moves nothing.
 */
#ifndef TAKT_STM32_EXCEPTIONS_H
#define TAKT_STM32_EXCEPTIONS_H

#include "stm32/crash.h"

/* The record of the last run. False: it did not end so. */
bool takt_exceptions_take_crash(struct crash_record *record);

/* Keeps a record and starts anew. */
_Noreturn void takt_exceptions_crash(enum crash_cause cause, uint32_t address, uint32_t caller);

#endif
