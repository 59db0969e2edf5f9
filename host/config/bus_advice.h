/*
 * What would let a bus carry the cycle of a machine: what has been tried by the same prediction
 * that refuses it.
 */
#ifndef TAKT_HOST_BUS_ADVICE_H
#define TAKT_HOST_BUS_ADVICE_H

#include "machine/machine.h"

#define BUS_ADVICE_MAX 255

/* "bitrate = 1000000, data_bitrate = 5000000 (CAN FD) or cycle_us = 1000 would do". */
/* bus: the one that cannot. */
void bus_advice_write(const struct machine *machine, unsigned bus, char text[BUS_ADVICE_MAX + 1]);

#endif
