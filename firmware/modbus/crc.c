#include "modbus/crc.h"

#define POLYNOMIAL 0xA001U /* 8005, bits reversed */

/* crc after eight more zero bits. */
static uint32_t shift8(uint32_t crc)
{
    for (int bit = 0; bit < 8; bit++)
        crc = (crc & 1U) != 0 ? crc >> 1 ^ POLYNOMIAL : crc >> 1;
    return crc;
}

uint16_t takt_crc16(const uint8_t *data, size_t length)
{
    uint32_t crc = 0xFFFF;

    for (size_t i = 0; i < length; i++)
        crc = shift8(crc ^ data[i]);
    return (uint16_t)crc;
}
