/*
 * A frame, bit by bit; a remote one has RTR 1 and no data:
 *
 *     | start 0 | identifier 11 | RTR r | IDE 0 | r0 0 | length 4 | data 8n | CRC 15 | end 10 |
 *     |<----------------------------- stuffed: 34 + 8n ----------------------------->|
 *
 * end: delimiters, acknowledge and seven bits of end of frame.
 *
 * The 19 bits of the header do not fill bytes. Five bits are put before them that change nothing:
 * zeros for the checksum, whose register starts at zero, and 10101 for stuffing, which as the
 * recessive bus before a frame ends in a single one. The checksum's 15 bits are filled up by one
 * bit opposite to the last, which cannot be stuffed after.
 */
#include "bus/frame_bits.h"

#define SECOND_NS 1000000000u

/* x^15 + x^14 + x^10 + x^8 + x^7 + x^4 + x^3 + 1, aligned to the upper 15 bits of 16. */
#define POLYNOMIAL (0x4599u << 1)

#define HEADER_BYTES          3
#define HEADER_PAD            0xA80000u /* 10101, then 19 zeros */
#define UNSTUFFED             44u       /* start to end without data: 34 + 10 */
#define EXTENDED_HEADER_BYTES 5
#define EXTENDED_PAD          0x8000000000u /* 1, then 39 zeros */
#define UNSTUFFED_EXTENDED    64u           /* 54 + 10 */
#define RUN_TO_STUFF          5

static uint16_t checksum_of_byte(unsigned byte)
{
    unsigned remainder = byte << 8;
    for (unsigned bit = 0; bit < 8; bit++)
        remainder = remainder & 0x8000u ? remainder << 1 ^ POLYNOMIAL : remainder << 1;
    return (uint16_t)remainder;
}

/* Parts of an octet of the table. */
#define VALUE    0x08u
#define STATE    0x3Fu
#define STUFFED  0xC0u
#define ONE_MORE 6 /* a stuffed bit is 1 << this */

static unsigned state_of(unsigned run, unsigned value)
{
    return (run - 1) << 4 | value << 3;
}

/* The low bits of value after a state; a stuffed bit begins a run of its own value. */
static unsigned stuffing_of_bits(unsigned state, unsigned bits_of, unsigned bits)
{
    unsigned run = (state >> 4) + 1, value = state >> 3 & 1, stuffed = 0;
    while (bits-- > 0) {
        unsigned next = bits_of >> bits & 1;
        run = next == value ? run + 1 : 1;
        value = next;
        if (run == RUN_TO_STUFF) {
            stuffed++;
            run = 1;
            value = !value;
        }
    }
    return stuffed << ONE_MORE | state_of(run, value);
}

/* The remainder of what has one byte more behind it. */
static uint16_t push_on(const struct frame_bits *tables, unsigned remainder)
{
    return (uint16_t)(tables->checksum[0][remainder >> 8] ^ (remainder << 8 & 0xFFFF));
}

void frame_bits_init(struct frame_bits *tables)
{
    for (unsigned byte = 0; byte < 256; byte++) {
        tables->checksum[0][byte] = checksum_of_byte(byte);
        tables->stuffing[byte] = 0;
        for (unsigned state = 0; state <= STATE; state += VALUE)
            tables->stuffing[byte] |= (uint64_t)stuffing_of_bits(state, byte, 8) << state;
    }
    for (unsigned behind = 1; behind < FRAME_BITS_SUMMED; behind++)
        for (unsigned byte = 0; byte < 256; byte++)
            tables->checksum[behind][byte] = push_on(tables, tables->checksum[behind - 1][byte]);
}

/*
 * A stream of which the checksum and stuffing are known so far. octet: the last one; what is above
 * it is others of its row. stuffed: as octets have it.
 */
struct stream_bits {
    const struct frame_bits *tables;
    unsigned checksum, stuffed;
    uint64_t octet;
};

static struct stream_bits begin_stream(const struct frame_bits *tables, unsigned state)
{
    return (struct stream_bits){.tables = tables, .octet = state};
}

static void take_stuffing(struct stream_bits *stream, uint64_t octet)
{
    stream->octet = octet;
    stream->stuffed += (unsigned)octet & STUFFED;
}

static void add_stuffing(struct stream_bits *stream, unsigned byte)
{
    take_stuffing(stream, stream->tables->stuffing[byte] >> (stream->octet & STATE));
}

/*
 * The low bytes of header, of which pad is no part, before so much data; the pad is in the first.
 */
static void add_header(struct stream_bits *stream, uint64_t header, uint64_t pad, unsigned bytes,
                       unsigned length)
{
    const uint16_t(*behind)[256] = &stream->tables->checksum[length];
    for (unsigned i = bytes; i-- > 0;) {
        stream->checksum ^= behind[i][header >> 8 * i & 0xFF];
        add_stuffing(stream, (unsigned)((header | pad) >> 8 * i) & 0xFF);
    }
}

static void add_data(struct stream_bits *stream, const uint8_t *data, unsigned length)
{
    const uint16_t(*behind)[256] = &stream->tables->checksum[length];
    for (unsigned i = 0; i < length; i++) {
        stream->checksum ^= (*--behind)[data[i]];
        add_stuffing(stream, data[i]);
    }
}

static unsigned stuffed_of(const struct stream_bits *stream)
{
    return stream->stuffed >> ONE_MORE;
}

/* Stuffed bits of the whole frame, its checksum included. */
static unsigned count_stuffed(struct stream_bits *stream)
{
    unsigned checksum = stream->checksum | (~stream->checksum >> 1 & 1u);
    add_stuffing(stream, checksum >> 8);
    add_stuffing(stream, checksum & 0xFF);
    return stuffed_of(stream);
}

/* Start 0, identifier 11, RTR, IDE 0, r0 0, length 4: 19 bits, five put before them. */
static inline unsigned count_of(const struct frame_bits *tables, const struct can_frame *frame,
                                unsigned length)
{
    struct stream_bits stream = begin_stream(tables, state_of(1, 0));
    unsigned header = can_rank(frame->id) << 6 | frame->length;
    add_header(&stream, header, HEADER_PAD, HEADER_BYTES, length);
    add_data(&stream, frame->data, length);
    return UNSTUFFED + 8u * length + count_stuffed(&stream);
}

/* SYNC, and PDOs of a target, of a statusword and a position, and of two targets: without loops. */
unsigned frame_bits_count(const struct frame_bits *tables, const struct can_frame *frame)
{
    const unsigned length = can_data_length(frame);
    switch (length) {
    case 0:
        return count_of(tables, frame, 0);
    case 4:
        return count_of(tables, frame, 4);
    case 6:
        return count_of(tables, frame, 6);
    case 8:
        return count_of(tables, frame, 8);
    default:
        return count_of(tables, frame, length);
    }
}

/*
 * 29-bit identifier: start 0, identifier 11, SRR 1, IDE 1, identifier 18, RTR, r1 0, r0 0, length
 * 4: 39 bits, one put before them.
 */
static unsigned count_extended(const struct frame_bits *tables, const struct wire_frame *frame)
{
    struct stream_bits stream = begin_stream(tables, state_of(1, 0));
    bool remote = frame->flags & WIRE_REMOTE;
    unsigned length = remote ? 0 : frame->length;
    uint64_t header = (uint64_t)(frame->id >> 18) << 27 | 3u << 25 |
                      (uint64_t)(frame->id & 0x3FFFFu) << 7 | (remote ? 1u << 6 : 0) |
                      frame->length;
    add_header(&stream, header, EXTENDED_PAD, EXTENDED_HEADER_BYTES, length);
    add_data(&stream, frame->data, length);
    return UNSTUFFED_EXTENDED + 8u * length + count_stuffed(&stream);
}

static unsigned count_standard(const struct frame_bits *tables, const struct wire_frame *frame)
{
    struct can_frame can = {0};
    (void)wire_frame_to_can(frame, &can); /* it is none of those that cannot */
    return frame_bits_count(tables, &can);
}

/*
 * CAN FD, ISO 11898-1:2015, 10.4.2; frame_levels.c has the picture. At the nominal rate start to
 * BRS (17 bits, 36 with a 29-bit identifier), acknowledge, its delimiter, end of frame: 9; at the
 * data rate ESI and DLC, the data, the CRC's field of 27 bits up to 16 bytes and 32 above (stuff
 * count 4, CRC 17 or 21, fixed stuff bits 6 or 7), its delimiter.
 */
#define FD_HEADER          17u
#define FD_HEADER_EXTENDED 36u
#define FD_CONTROL         5u
#define FD_END             9u
#define FD_SHORT_MAX       16u
#define FD_FDF             4u /* of FDF, res, BRS */

static unsigned crc_field(unsigned length)
{
    return length <= FD_SHORT_MAX ? 27 : 32;
}

/* SOF, identifier, the reserved bits, FDF 1, res 0, BRS. */
static uint64_t fd_header(const struct wire_frame *frame)
{
    const uint64_t end = FD_FDF | (frame->flags & WIRE_RATE_SWITCH ? 1u : 0);
    if (frame->flags & WIRE_EXTENDED)
        return (uint64_t)(frame->id >> 18) << 24 | (uint64_t)3 << 22 |
               (uint64_t)(frame->id & 0x3FFFFu) << 4 | end;
    return (uint64_t)frame->id << 5 | end;
}

static unsigned fd_control(const struct wire_frame *frame)
{
    return (frame->flags & WIRE_PASSIVE ? 1u << 4 : 0) | wire_frame_fd_code(frame->length);
}

/* The low bits of value, one by one. */
static void add_single_bits(struct stream_bits *stream, uint64_t value, unsigned bits)
{
    while (bits-- > 0)
        take_stuffing(stream, stuffing_of_bits((unsigned)stream->octet & STATE,
                                               (unsigned)(value >> bits) & 1, 1));
}

/*
 * A stuffed bit at the very end is not sent, since a fixed one follows. It would be opposite to the
 * last.
 */
static bool is_stuffed_last(const struct stream_bits *stream, unsigned last)
{
    return ((stream->octet & VALUE) != 0) != (last & 1u);
}

static struct frame_length count_fd(const struct frame_bits *tables, const struct wire_frame *frame)
{
    const unsigned header = frame->flags & WIRE_EXTENDED ? FD_HEADER_EXTENDED : FD_HEADER;
    const unsigned length = wire_frame_fd_length(frame->length), control = fd_control(frame);
    struct stream_bits stream = begin_stream(tables, state_of(1, 1));
    add_single_bits(&stream, fd_header(frame), header);
    const unsigned early = stuffed_of(&stream);
    add_single_bits(&stream, control, FD_CONTROL);
    for (unsigned i = 0; i < length; i++)
        add_stuffing(&stream, frame->data[i]);
    const unsigned last = length > 0 ? frame->data[length - 1] : control;
    const unsigned late = stuffed_of(&stream) - early - is_stuffed_last(&stream, last);
    const struct frame_length bits = {header + early + FD_END,
                                      FD_CONTROL + 8u * length + late + crc_field(length) + 1u};
    return frame->flags & WIRE_RATE_SWITCH ? bits
                                           : (struct frame_length){bits.nominal + bits.data, 0};
}

struct frame_length frame_bits_count_wire(const struct frame_bits *tables,
                                          const struct wire_frame *frame)
{
    if (frame->flags & WIRE_FD)
        return count_fd(tables, frame);
    return (struct frame_length){frame->flags & WIRE_EXTENDED ? count_extended(tables, frame)
                                                              : count_standard(tables, frame),
                                 0};
}

struct frame_length frame_bits_count_fd(const struct frame_bits *tables,
                                        const struct can_frame *frame)
{
    struct wire_frame wire;
    wire_frame_from_can(&wire, frame, true);
    return count_fd(tables, &wire);
}

/*
 * Classical: Davis, Burns, Bril, Lukkien: Controller Area Network schedulability analysis,
 * Real-Time Systems 35 (2007).
 *
 * CAN FD: of its 17 first bits the last that is stuffed behind is the 13th, since FDF, res and BRS
 * differ from each other; ESI begins a run of its own, and nothing is stuffed behind the last of
 * the 5 + 8n bits from it on:
 *     nominal  17 + floor((14 - 1) / 4) + 9 + 3 = 32
 *     data     5 + 8n + floor((5 + 8n - 2) / 4) + 27 or 32 + 1 = 33 + 10n, 38 + 10n above 16 bytes
 * (for n = 0: 33, too). As in Bordoloi, Samii: The frame packing problem for CAN-FD, RTSS 2014,
 * with the five bits of stuff count that ISO has added since.
 */
struct frame_length frame_bits_worst(unsigned length, bool fd)
{
    if (!fd)
        return (struct frame_length){55 + 10 * length, 0};
    length = wire_frame_fd_length(length);
    return (struct frame_length){32, 6 + crc_field(length) + 10 * length};
}

struct frame_times frame_bits_times(const struct frame_rates *rates)
{
    return (struct frame_times){(SECOND_NS + rates->nominal / 2) / rates->nominal,
                                rates->data > 0 ? (SECOND_NS + rates->data / 2) / rates->data : 0};
}
