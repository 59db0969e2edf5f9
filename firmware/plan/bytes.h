/*
 * Numbers as bytes at any place, one after the other, and back.
 */
#ifndef TAKT_PLAN_BYTES_H
#define TAKT_PLAN_BYTES_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

static inline void bytes_put(uint8_t **to, const void *value, size_t size)
{
    memcpy(*to, value, size);
    *to += size;
}

static inline void bytes_take(const uint8_t **from, void *value, size_t size)
{
    memcpy(value, *from, size);
    *from += size;
}

static inline void bytes_put_double(uint8_t **to, double value)
{
    bytes_put(to, &value, sizeof(value));
}

static inline double bytes_take_double(const uint8_t **from)
{
    double value;

    bytes_take(from, &value, sizeof(value));
    return value;
}

static inline void bytes_put_word(uint8_t **to, uint32_t value)
{
    bytes_put(to, &value, sizeof(value));
}

static inline uint32_t bytes_take_word(const uint8_t **from)
{
    uint32_t value;

    bytes_take(from, &value, sizeof(value));
    return value;
}

static inline void bytes_put_half(uint8_t **to, uint32_t value)
{
    const uint16_t half = value & 0xffffU;

    bytes_put(to, &half, sizeof(half));
}

static inline uint16_t bytes_take_half(const uint8_t **from)
{
    uint16_t half;

    bytes_take(from, &half, sizeof(half));
    return half;
}

static inline void bytes_put_byte(uint8_t **to, unsigned value)
{
    *(*to)++ = (uint8_t)value;
}

static inline unsigned bytes_take_byte(const uint8_t **from)
{
    return *(*from)++;
}

#endif
