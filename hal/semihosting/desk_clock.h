/*
 * What the image of a run on the desk measures its cycles with. Under -icount shift=0 it counts
 * instructions, one a nanosecond.
 */
#ifndef TAKT_SEMIHOSTING_DESK_CLOCK_H
#define TAKT_SEMIHOSTING_DESK_CLOCK_H

#include <stdint.h>

uint32_t takt_desk_clock_hz(void);

void takt_desk_clock_start(void);
uint32_t takt_desk_clock_now(void);
uint32_t takt_desk_clock_ns_since(uint32_t start);

#endif
