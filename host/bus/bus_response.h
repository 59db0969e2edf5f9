/*
 * Worst-case response times on a CAN bus, before anything runs: from the moment a frame is given to
 * a controller to its last bit.
 *
 * Davis, Burns, Bril, Lukkien: Controller Area Network (CAN) schedulability analysis: refuted,
 * revisited and revised, Real-Time Systems 35 (2007), the exact test.
 */
#ifndef TAKT_BUS_BUS_RESPONSE_H
#define TAKT_BUS_BUS_RESPONSE_H

#include "bus/frame_bits.h"

#include <stdbool.h>
#include <stdint.h>

/*
 * A frame that is sent again and again. Its rank is its identifier: the lower goes first; no two
 * may be equal.
 */
struct bus_message {
    uint16_t id;
    uint8_t length;     /* bytes of data */
    bool is_remote;     /* a classical frame on any bus */
    uint64_t period_ns; /* shortest time between two of them */
    uint64_t jitter_ns; /* how much later than on time it may be given at most */
};

/*
 * worst_ns[i]: the longest that messages[i] may take, from when it should have been given, jitter
 * included; UINT64_MAX: no bound, as with all that rank behind a bus at its limit. False: there is
 * one without a bound.
 */
bool bus_response_predict(const struct bus_message messages[], unsigned count,
                          const struct frame_rates *rates, uint64_t worst_ns[]);

/*
 * Part of the time that the bus is occupied, with worst-case stuffing; from 1 on it cannot carry
 * them.
 */
double bus_response_utilisation(const struct bus_message messages[], unsigned count,
                                const struct frame_rates *rates);

#endif
