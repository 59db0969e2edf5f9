/*
 * Node ids and the predefined connection set: which identifier a frame has says what it is and
 * whose.
 *
 * CiA 301, 7.3.5: an 11-bit identifier is a function code (upper 4 bits) and a node id (lower 7
 * bits).
 */
#ifndef TAKT_CANOPEN_NODE_H
#define TAKT_CANOPEN_NODE_H

#include "hal/can.h"

#include <stdint.h>

#define NODE_MIN 1
#define NODE_MAX 127

#define NODE_FUNCTION_MASK 0x780u
#define NODE_ID_MASK       0x07Fu

/* A remote frame has no function: it asks for one. */
static inline uint16_t node_function(uint16_t cob_id)
{
    return (uint16_t)(cob_id & (CAN_REMOTE | NODE_FUNCTION_MASK));
}

static inline uint8_t node_id(uint16_t cob_id)
{
    return (uint8_t)(cob_id & NODE_ID_MASK);
}

#endif
