/*
 * Numbers in CANopen frames: least significant byte first (CiA 301, 7.1.4), whatever the
 * processor's own order.
 */
#ifndef TAKT_CANOPEN_LITTLE_ENDIAN_H
#define TAKT_CANOPEN_LITTLE_ENDIAN_H

#include <stdint.h>

static inline uint16_t little_endian_read16(const uint8_t *bytes)
{
    return (uint16_t)(bytes[0] | (unsigned)bytes[1] << 8);
}

static inline uint32_t little_endian_read32(const uint8_t *bytes)
{
    return little_endian_read16(bytes) | (uint32_t)little_endian_read16(bytes + 2) << 16;
}

static inline void little_endian_write16(uint8_t *bytes, uint16_t value)
{
    bytes[0] = (uint8_t)value;
    bytes[1] = (uint8_t)(value >> 8);
}

static inline void little_endian_write32(uint8_t *bytes, uint32_t value)
{
    little_endian_write16(bytes, (uint16_t)value);
    little_endian_write16(bytes + 2, (uint16_t)(value >> 16));
}

#endif
