#include "crc32.h"

#define CRC32_REFLECTED UINT32_C(0xedb88320)

/* Bit by bit: tables are checked when they are loaded, not in the control cycle. */
uint32_t takt_crc32_add(uint32_t crc, const void *bytes, size_t size)
{
    const uint8_t *byte = bytes;

    crc = ~crc;
    for (size_t i = 0; i < size; i++) {
        crc ^= byte[i];
        for (unsigned bit = 0; bit < 8; bit++) {
            crc = (crc >> 1) ^ ((crc & 1U) != 0 ? CRC32_REFLECTED : 0U);
        }
    }
    return ~crc;
}
