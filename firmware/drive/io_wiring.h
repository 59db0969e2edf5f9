/*
 * What the bits of the I/O nodes on the bus (CiA 401) are: as a machine file says it, and as the
 * controller keeps it.
 */
#ifndef TAKT_DRIVE_IO_WIRING_H
#define TAKT_DRIVE_IO_WIRING_H

#include <stdbool.h>
#include <stdint.h>

#define IO_NODES_MAX 2

/* Bits of a node that can be wired, of either direction: the first of its objects 6200 and 6000. */
#define IO_BITS_MAX 16

/* What a bit is. IO_PROGRAM + n: line n of the program, P0 ... P31 of M62 to M66. */
enum io_bit {
    IO_FREE, /* nothing: such an output is low */
    IO_PROGRAM,
    IO_FLOOD = IO_PROGRAM + 32, /* outputs: M8 */
    IO_MIST,                    /* M7 */
    IO_SPINDLE,                 /* it turns, or is held at an angle (M3, M4, M19) */
    IO_SPINDLE_CCW,             /* it turns counter-clockwise (M4) */
    IO_STOP,                    /* inputs: low stops everything at once, and keeps it stopped */
    IO_LIMIT,                   /* becoming low stops everything at once */
    IO_TOOL_CHANGED,            /* the changer's answer to: */
    IO_TOOL_CHANGE,             /* outputs: M6 asks for the tool */
    IO_TOOL,                    /* and 7 more: bits of its number, as T has told it */
    IO_BIT_COUNT = IO_TOOL + 8
};

/* Added to one of these: high on the wire is low here. */
#define IO_INVERTED 0x80U

/* Analogue outputs of a node that can be wired: the first of its object 6411. */
#define IO_ANALOGUE_MAX 4

/* Bytes alone: it is stored as it is. */
struct io_wiring {
    uint8_t node; /* CANopen node id, 1 ... 127; 0: there is no such node */
    uint8_t output[IO_BITS_MAX], input[IO_BITS_MAX]; /* enum io_bit, of bit 0, 1, ... */
    uint8_t analogue[IO_ANALOGUE_MAX / 2];           /* four bits of each, io_get_analogue */
    uint8_t bus;                                     /* that it is on, 0 ... CAN_BUSES_MAX - 1 */
};

/* Which analogue output of the program it is: 0: none, 1 ... 4: E0 ... E3 of M67 and M68. */
static inline unsigned io_get_analogue(const struct io_wiring *wiring, unsigned channel)
{
    const unsigned pair = wiring->analogue[channel / 2];
    return pair >> 4 * (channel % 2) & 0xFU;
}

/* From the first to the last that is wired: 0 ... IO_ANALOGUE_MAX. */
static inline unsigned io_wired_analogues(const struct io_wiring *wiring)
{
    unsigned count = IO_ANALOGUE_MAX;
    while (count > 0 && io_get_analogue(wiring, count - 1) == 0)
        count--;
    return count;
}

/* Bits from 0 to the last that is wired: 0 ... IO_BITS_MAX. */
static inline unsigned io_wired_bits(const uint8_t bit[IO_BITS_MAX])
{
    unsigned count = IO_BITS_MAX;
    while (count > 0 && bit[count - 1] == IO_FREE)
        count--;
    return count;
}

/* enum io_bit, inverted or not. */
static inline unsigned io_kind(uint8_t bit)
{
    return bit & (IO_INVERTED - 1U);
}

static inline bool io_is_output(uint8_t bit)
{
    const unsigned kind = io_kind(bit);
    return kind < IO_STOP || (kind >= IO_TOOL_CHANGE && kind < IO_BIT_COUNT);
}
static inline bool io_is_input(uint8_t bit)
{
    const unsigned kind = io_kind(bit);
    return kind < IO_FLOOD || (kind >= IO_STOP && kind <= IO_TOOL_CHANGED);
}

#endif
