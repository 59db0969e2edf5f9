/*
 * A Modbus server's protocol data unit: a request of function code and data in, the reply out. What
 * the registers mean is the business of a struct modbus_map; how frames travel, of rtu.h and tcp.h.
 *
 * Functions (Modbus Application Protocol 1.1b3): 01 read coils, 03 read holding registers, 04 read
 * input registers, 05 and 06 write one, 15 and 16 write several, 23 write and read holding
 * registers. Any other: exception 01.
 */
#ifndef TAKT_MODBUS_MODBUS_H
#define TAKT_MODBUS_MODBUS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Longest request or reply, function code included. */
#define MODBUS_PDU_MAX 253

/* Most that one request may name. */
#define MODBUS_READ_BITS_MAX      2000
#define MODBUS_READ_WORDS_MAX     125
#define MODBUS_WRITE_BITS_MAX     1968
#define MODBUS_WRITE_WORDS_MAX    123
#define MODBUS_EXCHANGE_WORDS_MAX 121 /* written by function 23 */

enum modbus_exception {
    MODBUS_GOOD = 0,
    MODBUS_FUNCTION = 1, /* no such function */
    MODBUS_ADDRESS = 2,  /* no such register, or it cannot be written */
    MODBUS_VALUE = 3,    /* quantity, length or value out of range */
    MODBUS_STATE = 4,    /* not in this state */
    MODBUS_BUSY = 6      /* not now: try again */
};

enum modbus_table { MODBUS_COILS, MODBUS_INPUTS, MODBUS_HOLDINGS };

/*
 * The registers behind a server. Data travels as on the wire: words with the high byte first, bits
 * eight to a byte, the first in bit 0. address + count is at most 65536 and count at least 1 when
 * these are called. A request that is refused has changed nothing.
 */
struct modbus_map {
    /* Fills data: 2 count bytes for words, (count + 7) / 8 for coils, unused bits 0. */
    enum modbus_exception (*read)(void *context, enum modbus_table table, uint16_t address,
                                  uint16_t count, uint8_t *data);
    enum modbus_exception (*write)(void *context, enum modbus_table table, uint16_t address,
                                   uint16_t count, const uint8_t *data);
    void *context; /* owned by whoever made the map */
};

/*
 * Answers a request of length bytes, 1 ... MODBUS_PDU_MAX, function code first. Writes the reply to
 * reply[MODBUS_PDU_MAX] and returns its length, at least 2.
 */
size_t takt_modbus_answer(const struct modbus_map *map, const uint8_t *request, size_t length,
                          uint8_t *reply);

/*
 * Length that the request whose first bytes these are will have; 0: more bytes are needed to tell,
 * or the function is not one of ours.
 */
size_t takt_modbus_request_length(const uint8_t *request, size_t length);

/* High byte first. */
static inline uint16_t modbus_read16(const uint8_t *at)
{
    return (uint16_t)(at[0] << 8 | at[1]);
}

static inline void modbus_write16(uint8_t *at, uint16_t value)
{
    at[0] = (uint8_t)(value >> 8);
    at[1] = (uint8_t)value;
}

#endif
