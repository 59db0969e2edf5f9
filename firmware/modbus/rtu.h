/*
 * A Modbus RTU server: bytes of a serial line in, replies out. Time is an argument, in microseconds
 * that wrap.
 *
 *     unit, PDU, CRC low, CRC high, silence of 3.5 characters
 *
 * A request of a known function is taken as soon as it is complete and its CRC is right: its length
 * follows from its first bytes. So gaps between its bytes, as operating systems and emulators make
 * them, do no harm as long as they are shorter than the gap that ends a frame. Everything else ends
 * with that gap: functions we do not have, and bytes that are no request (noise, what other servers
 * reply), which are dropped.
 */
#ifndef TAKT_MODBUS_RTU_H
#define TAKT_MODBUS_RTU_H

#include "modbus/modbus.h"

#define MODBUS_RTU_MAX       (MODBUS_PDU_MAX + 3)
#define MODBUS_RTU_UNIT_MAX  247
#define MODBUS_RTU_BROADCAST 0

struct modbus_rtu {
    struct modbus_map map;
    uint8_t unit;
    uint32_t gap_us;
    uint32_t last_us; /* when the last byte came */
    size_t length;
    bool lost; /* too long for any frame: dropped until the next gap */
    uint8_t frame[MODBUS_RTU_MAX];
};

/*
 * The silence that ends a frame at a rate of bauds with bits per character (11 by the standard, 10
 * without parity): 3.5 characters, and 1750 us above 19200 baud (Modbus over Serial Line 1.02,
 * 2.5.1.1).
 */
uint32_t takt_modbus_rtu_gap_us(uint32_t bauds, uint32_t bits);

/* unit: 1 ... MODBUS_RTU_UNIT_MAX. */
void takt_modbus_rtu_init(struct modbus_rtu *rtu, const struct modbus_map *map, uint8_t unit,
                          uint32_t gap_us);

/*
 * A byte has come. Returns the length of the reply to send, in reply[MODBUS_RTU_MAX]; 0: none.
 * Between the call and the first byte sent the line must be silent for 3.5 characters: the caller's
 * business.
 */
size_t takt_modbus_rtu_take(struct modbus_rtu *rtu, uint8_t byte, uint32_t now_us, uint8_t *reply);

/*
 * No byte has come until now: ends a frame when the gap is over. Returns as takt_modbus_rtu_take.
 */
size_t takt_modbus_rtu_idle(struct modbus_rtu *rtu, uint32_t now_us, uint8_t *reply);

#endif
