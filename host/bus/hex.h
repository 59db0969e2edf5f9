/*
 * Hexadecimal digits, as the text forms of frames have them.
 */
#ifndef TAKT_BUS_HEX_H
#define TAKT_BUS_HEX_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Writes `digits` upper-case digits; returns what comes after them. */
static inline char *hex_put(char *text, uint32_t value, unsigned digits)
{
    for (unsigned i = digits; i-- > 0; value >>= 4)
        text[i] = "0123456789ABCDEF"[value & 15];
    return text + digits;
}

/* -1: no digit. */
static inline int hex_digit(char c)
{
    if (c >= '0' && c <= '9')
        return c - '0';
    if (c >= 'a' && c <= 'f')
        return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/* Reads `digits` (at most 8) digits. False: there is something else among them. */
static inline bool hex_get(const char *text, unsigned digits, uint32_t *value)
{
    *value = 0;
    for (unsigned i = 0; i < digits; i++) {
        int digit = hex_digit(text[i]);
        if (digit < 0)
            return false;
        *value = *value << 4 | (uint32_t)digit;
    }
    return digits > 0;
}

/* Reads `count` bytes of two digits each. */
static inline bool hex_get_bytes(const char *text, unsigned count, uint8_t *data)
{
    uint32_t value;
    for (unsigned i = 0; i < count; i++) {
        if (!hex_get(text + (size_t)2 * i, 2, &value))
            return false;
        data[i] = (uint8_t)value;
    }
    return true;
}

#endif
