/*
 * A compiled program: what is stored, sent and replayed. All numbers are little-endian.
 *
 *     header, records, each: kind (1 byte), length of what follows (2), that, CRC-32 (4)
 *
 *     section   first block (4), blocks (4), intervals (4), start of X, Y, Z (3 x 8): from rest to rest
 *     knots     intervals here (1), third differences of the control points (3 x 2 each), ends
 *     more      ends (1) of blocks where the next interval begins
 *     end       of the program
 *
 * A record's CRC goes on from that of the record before, so that none can be missing. Positions are
 * whole multiples of the quantum, 2^-quantum_bits mm. A section's curve is a uniform cubic B-spline
 * whose first three control points are the start; interval i adds control point i + 3.
 *
 * The ends of blocks are bits, the lowest of a byte first: k (REPLAY_RICE_BITS), then of every
 * interval how many end in it, n: n / 2^k ones, a zero, n mod 2^k in k bits; and where, in parts of
 * the interval, less one:
 *
 *     n = 1        of 256
 *     n = 2        both of 32
 *     n = 3 ... 7  the last of 32, the others evenly before it
 *     n > 7        nothing: evenly over the interval
 *
 * The last block of a section ends with it and is not told.
 */
#ifndef TAKT_REPLAY_FORMAT_H
#define TAKT_REPLAY_FORMAT_H

#include "base/point.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define REPLAY_VERSION 2U

/* Bytes of the header, and of the longest record. */
#define REPLAY_HEADER_BYTES 160
#define REPLAY_RECORD_MAX   640

/* Bytes of a record around what it holds. */
#define REPLAY_RECORD_HEAD 3
#define REPLAY_RECORD_TAIL 4

/* Intervals, and block ends, in one record. */
#define REPLAY_RECORD_INTERVALS 32
#define REPLAY_RECORD_ENDS      240

/* Parts of an interval in which block ends are told, and bits of a part; of one of several. */
#define REPLAY_END_PARTS       256
#define REPLAY_END_BITS        8
#define REPLAY_END_BITS_COARSE 5

#define REPLAY_RICE_BITS 3

/* From this number of ends in an interval on only their number is told. */
#define REPLAY_ENDS_CROWD 8

#define REPLAY_SECTION_BYTES 36

enum replay_kind { REPLAY_SECTION = 1, REPLAY_KNOTS = 2, REPLAY_END = 3, REPLAY_MORE = 4 };

struct replay_header {
    uint32_t cycle_us;
    uint32_t step_cycles;     /* control cycles of an interval at the rate 1, >= 1 */
    uint32_t quantum_bits;    /* 0 ... 40 */
    uint32_t ceiling_percent; /* the feed override that the rate 1 is, 100 ... 120 */
    uint32_t blocks;
    uint32_t sections;
    uint64_t intervals;
    uint64_t program;   /* digest of the canonical moves */
    uint32_t text_size; /* of the program's text, bytes, and its CRC-32; 0: not known */
    uint32_t text_crc;
    double kept; /* part of acceleration and jerk that is used at most */
    double velocity_mm_s[AXIS_LINEAR_COUNT]; /* the limits it keeps; 0: no such axis */
    double acceleration_mm_s2[AXIS_LINEAR_COUNT];
    double jerk_mm_s3[AXIS_LINEAR_COUNT];
};

/* What is wrong with a header. */
enum replay_fault {
    REPLAY_GOOD,
    REPLAY_FOREIGN, /* no compiled program */
    REPLAY_OTHER_VERSION,
    REPLAY_DAMAGED
};

void takt_replay_header_write(const struct replay_header *h, uint8_t bytes[REPLAY_HEADER_BYTES]);
enum replay_fault takt_replay_header_read(struct replay_header *h,
                                          const uint8_t bytes[REPLAY_HEADER_BYTES]);

/* Bits in bytes. What is beyond the end reads as 0, and is not written. */
struct replay_bits {
    uint8_t *bytes; /* zero before they are written */
    size_t size;
    size_t at; /* bit, may be beyond the end */
};

void takt_replay_put_bits(struct replay_bits *b, unsigned value, unsigned count);
unsigned takt_replay_get_bits(struct replay_bits *b, unsigned count);

/* Numbers of size bytes. */
void takt_replay_put(uint8_t *bytes, uint64_t value, unsigned size);
uint64_t takt_replay_get(const uint8_t *bytes, unsigned size);

#endif
