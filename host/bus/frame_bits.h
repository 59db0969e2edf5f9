/*
 * Length on the wire of a CAN frame, in bit times (ISO 11898-1).
 *
 * The transmitter stuffs: after five equal bits between start of frame and the last bit of the
 * checksum it inserts one of the other value. How many depends on every bit, checksum included, so
 * a frame's length does too.
 */
#ifndef TAKT_BUS_FRAME_BITS_H
#define TAKT_BUS_FRAME_BITS_H

#include "bus/wire_frame.h"
#include "hal/can.h"

#include <stdint.h>

/* Intermission: recessive bits before the next frame may begin. */
#define FRAME_BITS_INTERMISSION 3

/*
 * Tables that take a byte at a time.
 *
 * state: bits 3 ... 1 the number of equal bits at the end of the stream (1 ... 4), bit 0 their
 * value. stuffing [state][byte] is the state after the byte in its bits 3 ... 0 and the number of
 * bits stuffed (0 ... 2) above them. checksum[byte] is the CRC-15 remainder of the byte, in the
 * upper 15 bits of 16.
 */
#define FRAME_BITS_STATES 10

struct frame_bits {
    uint16_t checksum[256];
    uint8_t stuffing[FRAME_BITS_STATES][256];
};

void frame_bits_init(struct frame_bits *tables);

/*
 * Bit times from start of frame to the end of the frame, without intermission. frame->length <=
 * CAN_DATA_MAX.
 */
unsigned frame_bits_count(const struct frame_bits *tables, const struct can_frame *frame);

/*
 * The same for a frame of any kind: classical ones exactly, CAN FD ones at most, as if the nominal
 * rate were used throughout.
 */
unsigned frame_bits_count_wire(const struct frame_bits *tables, const struct wire_frame *frame);

/* For a frame of 8 bytes with worst-case stuffing, without intermission. */
#define FRAME_BITS_MAX 132

/*
 * The levels on the wire, bit by bit, stuffed bits included: 0 dominant, 1 recessive; as many as
 * frame_bits_count says. Returns how many of them, from the start, obey stuffing.
 */
unsigned frame_bits_levels(const struct frame_bits *tables, const struct can_frame *frame,
                           uint8_t level[FRAME_BITS_MAX]);

/* Bit times with worst-case stuffing and intermission: 55 + 10 length. */
unsigned frame_bits_worst(unsigned length);

#endif
