/*
 * The host's clock, for figures about speed alone: nothing a run computes depends on it.
 */
#ifndef TAKT_HOST_STOPWATCH_H
#define TAKT_HOST_STOPWATCH_H

#include <stdint.h>

/* Nanoseconds since some moment, never backwards. */
uint64_t stopwatch_now_ns(void);

#endif
