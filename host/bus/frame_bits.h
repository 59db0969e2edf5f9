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
 * checksum[behind][byte] is what a byte with so many bytes behind it adds to the CRC-15 remainder,
 * in the upper 15 bits of 16: the remainder of several bytes is the sum (exclusive or) of what each
 * adds.
 *
 * stuffing[byte] has an octet for each of eight states: the state after the byte in its lower six
 * bits, and above them the number of bits stuffed, 0 ... 2. A state is where its own octet begins,
 * so a byte is a shift; it says how many equal bits are at the end of the stream, 1 ... 4, and
 * their value.
 */
#define FRAME_BITS_SUMMED 13 /* header with a 29-bit identifier, and data of a classical frame */

struct frame_bits {
    uint16_t checksum[FRAME_BITS_SUMMED][256];
    uint64_t stuffing[256];
};

void frame_bits_init(struct frame_bits *tables);

/*
 * Bit times from start of frame to the end of the frame, without intermission, of a classical
 * frame. frame->length <= CAN_CLASSIC_MAX.
 */
unsigned frame_bits_count(const struct frame_bits *tables, const struct can_frame *frame);

/*
 * Bit times at either rate. The rate is switched within a bit, at its sample point: to the higher
 * one in BRS, back in the CRC delimiter. What the one has at the nominal rate the other lacks, so
 * together they are one bit of each; here BRS counts for nominal, and the delimiter for data.
 */
struct frame_length {
    unsigned nominal, data;
};

/*
 * The bit rates of a bus, bit/s. data: of CAN FD behind the rate switch; 0: the bus has classical
 * frames alone.
 */
struct frame_rates {
    uint32_t nominal, data;
};

/* Length of a frame of any kind, exactly; without intermission. */
struct frame_length frame_bits_count_wire(const struct frame_bits *tables,
                                          const struct wire_frame *frame);
/* Of a data frame as CAN FD has it. */
struct frame_length frame_bits_count_fd(const struct frame_bits *tables,
                                        const struct can_frame *frame);
/* Length of a frame of a port; fd: one that speaks CAN FD. */
static inline struct frame_length frame_bits_count_port(const struct frame_bits *tables,
                                                        const struct can_frame *frame, bool fd)
{
    if (fd && !can_is_remote(frame))
        return frame_bits_count_fd(tables, frame);
    return (struct frame_length){frame_bits_count(tables, frame), 0};
}

/*
 * With worst-case stuffing and intermission, of a data frame with an 11-bit identifier; README.md
 * has the formulas.
 */
struct frame_length frame_bits_worst(unsigned length, bool fd);

/* One bit of each rate, rounded to a nanosecond; data_ns 0: there is none. */
struct frame_times {
    uint64_t bit_ns, data_ns;
};
struct frame_times frame_bits_times(const struct frame_rates *rates);
static inline uint64_t frame_bits_ns(const struct frame_times *times,
                                     const struct frame_length *length)
{
    return length->nominal * times->bit_ns + length->data * times->data_ns;
}

#endif
