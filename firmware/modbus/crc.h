/*
 * The checksum of RTU frames, and of the chunks of an upload.
 */
#ifndef TAKT_MODBUS_CRC_H
#define TAKT_MODBUS_CRC_H

#include <stddef.h>
#include <stdint.h>

/* CRC-16/MODBUS: polynomial 8005 reflected, start FFFF. On the wire its low byte comes first. */
uint16_t takt_crc16(const uint8_t *data, size_t length);

#endif
