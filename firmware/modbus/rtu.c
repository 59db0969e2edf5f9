#include "modbus/rtu.h"

#include "base/assert.h"
#include "modbus/crc.h"

#include <string.h>

/* Above this rate the gap no longer shrinks. */
#define FAST_BAUDS  19200
#define FAST_GAP_US 1750

/* Unit, function, CRC. */
#define FRAME_MIN 4

uint32_t takt_modbus_rtu_gap_us(uint32_t bauds, uint32_t bits)
{
    TAKT_ASSERT(bauds > 0);
    if (bauds > FAST_BAUDS)
        return FAST_GAP_US;
    /* 3.5 bits 1e6 / bauds, rounded up */
    return (bits * 3500000U + bauds - 1) / bauds;
}

void takt_modbus_rtu_init(struct modbus_rtu *rtu, const struct modbus_map *map, uint8_t unit,
                          uint32_t gap_us)
{
    memset(rtu, 0, sizeof *rtu);
    rtu->map = *map;
    rtu->unit = unit;
    rtu->gap_us = gap_us;
}

static bool is_whole(const struct modbus_rtu *rtu)
{
    uint16_t crc;

    TAKT_ASSERT(rtu->length <= sizeof rtu->frame);
    if (rtu->length < FRAME_MIN || rtu->lost)
        return false;
    crc = takt_crc16(rtu->frame, rtu->length - 2);
    return rtu->frame[rtu->length - 2] == (uint8_t)crc &&
           rtu->frame[rtu->length - 1] == (uint8_t)(crc >> 8);
}

/* A broadcast is done and not answered; what it reads goes nowhere. */
static size_t answer(struct modbus_rtu *rtu, uint8_t *reply)
{
    const size_t request = rtu->length - 3;
    const uint8_t unit = rtu->frame[0];
    size_t length;
    uint16_t crc;

    TAKT_ASSERT(rtu->length >= FRAME_MIN && rtu->length <= sizeof rtu->frame);
    if (unit != rtu->unit && unit != MODBUS_RTU_BROADCAST)
        return 0;
    length = 1 + takt_modbus_answer(&rtu->map, rtu->frame + 1, request, reply + 1);
    if (unit == MODBUS_RTU_BROADCAST)
        return 0;
    reply[0] = unit;
    crc = takt_crc16(reply, length);
    reply[length] = (uint8_t)crc;
    reply[length + 1] = (uint8_t)(crc >> 8);
    return length + 2;
}

static size_t end_frame(struct modbus_rtu *rtu, uint8_t *reply)
{
    const size_t length = is_whole(rtu) ? answer(rtu, reply) : 0;

    rtu->length = 0;
    rtu->lost = false;
    return length;
}

/* The request is as long as its first bytes say. */
static bool is_complete(const struct modbus_rtu *rtu)
{
    size_t length;

    TAKT_ASSERT(rtu->length > 0);
    length = takt_modbus_request_length(rtu->frame + 1, rtu->length - 1);
    return length > 0 && rtu->length == length + 3;
}

static void add_byte(struct modbus_rtu *rtu, uint8_t byte, uint32_t now_us)
{
    rtu->last_us = now_us;
    if (rtu->length < sizeof rtu->frame)
        rtu->frame[rtu->length++] = byte;
    else
        rtu->lost = true;
}

size_t takt_modbus_rtu_take(struct modbus_rtu *rtu, uint8_t byte, uint32_t now_us, uint8_t *reply)
{
    const size_t length = takt_modbus_rtu_idle(rtu, now_us, reply);

    add_byte(rtu, byte, now_us);
    if (length > 0 || !is_complete(rtu) || !is_whole(rtu))
        return length;
    return end_frame(rtu, reply);
}

size_t takt_modbus_rtu_idle(struct modbus_rtu *rtu, uint32_t now_us, uint8_t *reply)
{
    if (rtu->length == 0 || now_us - rtu->last_us < rtu->gap_us)
        return 0;
    return end_frame(rtu, reply);
}
