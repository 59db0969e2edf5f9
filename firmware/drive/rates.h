/*
 * Bit rates of the drives' bus.
 */
#ifndef TAKT_DRIVE_RATES_H
#define TAKT_DRIVE_RATES_H

#include <stdint.h>

/*
 * bit/s. data: behind the rate switch of CAN FD, > 0: its data frames are; 0: they are classical.
 */
struct drives_rates {
    uint32_t nominal, data;
};

#endif
