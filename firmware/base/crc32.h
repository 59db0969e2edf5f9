/*
 * CRC-32 of ISO 3309 and IEEE 802.3 (polynomial 04C11DB7, reflected): what zip, PNG and Ethernet
 * use.
 */
#ifndef TAKT_BASE_CRC32_H
#define TAKT_BASE_CRC32_H

#include <stddef.h>
#include <stdint.h>

#define CRC32_START 0U

/* Goes on from the CRC of what came before. */
uint32_t takt_crc32_add(uint32_t crc, const void *bytes, size_t size);

#endif
