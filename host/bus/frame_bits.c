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

#include <string.h>

/* x^15 + x^14 + x^10 + x^8 + x^7 + x^4 + x^3 + 1, aligned to the upper 15 bits of 16. */
#define POLYNOMIAL (0x4599u << 1)

#define HEADER_PAD         0xA80000u     /* 10101, then 19 zeros */
#define UNSTUFFED          44u           /* start to end without data: 34 + 10 */
#define EXTENDED_PAD       0x8000000000u /* 1, then 39 zeros */
#define UNSTUFFED_EXTENDED 64u           /* 54 + 10 */
#define HEADER_BITS        19u
#define RUN_TO_STUFF       5
#define STUFFED_STEP       16u /* one stuffed bit in an entry of the table */

static uint16_t checksum_of_byte(unsigned byte)
{
    unsigned remainder = byte << 8;
    for (unsigned bit = 0; bit < 8; bit++)
        remainder = remainder & 0x8000u ? remainder << 1 ^ POLYNOMIAL : remainder << 1;
    return (uint16_t)remainder;
}

static unsigned state_of(unsigned run, unsigned value)
{
    return run << 1 | value;
}

/* The bits of a byte after a state; a stuffed bit begins a run of its own value. */
static uint8_t stuffing_of_byte(unsigned state, unsigned byte)
{
    unsigned run = state >> 1, value = state & 1, stuffed = 0;
    for (unsigned bit = 8; bit-- > 0;) {
        unsigned next = byte >> bit & 1;
        run = next == value ? run + 1 : 1;
        value = next;
        if (run == RUN_TO_STUFF) {
            stuffed++;
            run = 1;
            value = !value;
        }
    }
    return (uint8_t)(stuffed * STUFFED_STEP + state_of(run, value));
}

void frame_bits_init(struct frame_bits *tables)
{
    for (unsigned byte = 0; byte < 256; byte++) {
        tables->checksum[byte] = checksum_of_byte(byte);
        for (unsigned state = 0; state < FRAME_BITS_STATES; state++)
            tables->stuffing[state][byte] = stuffing_of_byte(state, byte);
    }
}

static unsigned add_checksum(const struct frame_bits *tables, unsigned checksum, unsigned byte)
{
    return tables->checksum[(checksum >> 8 ^ byte) & 0xFF] ^ (checksum << 8 & 0xFFFF);
}

/*
 * entry: what the table said of the bytes before; the counts of stuffed bits add up above the
 * state.
 */
static unsigned add_stuffing(const struct frame_bits *tables, unsigned entry, unsigned byte)
{
    return (entry & ~15u) + tables->stuffing[entry & 15u][byte & 0xFF];
}

/* A stream of which the checksum and stuffing are known so far. */
struct stream_bits {
    const struct frame_bits *tables;
    unsigned checksum, entry;
};

/* The low 8 count bits of value; what stands above them is of no matter. */
static void add_bytes(struct stream_bits *stream, uint64_t summed, uint64_t stuffed, unsigned count)
{
    for (unsigned shift = 8 * count; shift > 0; shift -= 8) {
        stream->checksum = add_checksum(stream->tables, stream->checksum,
                                        (unsigned)(summed >> (shift - 8)) & 0xFF);
        stream->entry =
            add_stuffing(stream->tables, stream->entry, (unsigned)(stuffed >> (shift - 8)) & 0xFF);
    }
}

static void add_data(struct stream_bits *stream, const uint8_t *data, unsigned length)
{
    for (unsigned i = 0; i < length; i++) {
        stream->checksum = add_checksum(stream->tables, stream->checksum, data[i]);
        stream->entry = add_stuffing(stream->tables, stream->entry, data[i]);
    }
}

/* Stuffed bits of the whole frame, its checksum included. */
static unsigned count_stuffed(const struct stream_bits *stream)
{
    unsigned checksum = stream->checksum | (~stream->checksum >> 1 & 1u);
    unsigned entry = add_stuffing(stream->tables, stream->entry, checksum >> 8);
    return add_stuffing(stream->tables, entry, checksum) / STUFFED_STEP;
}

static unsigned header_of(const struct can_frame *frame)
{
    return can_rank(frame->id) << 6 | frame->length;
}

unsigned frame_bits_count(const struct frame_bits *tables, const struct can_frame *frame)
{
    struct stream_bits stream = {.tables = tables, .entry = state_of(1, 0)};
    unsigned header = header_of(frame), length = can_data_length(frame);
    add_bytes(&stream, header, header | HEADER_PAD, 3);
    add_data(&stream, frame->data, length);
    return UNSTUFFED + 8u * length + count_stuffed(&stream);
}

/*
 * 29-bit identifier: start 0, identifier 11, SRR 1, IDE 1, identifier 18, RTR, r1 0, r0 0, length
 * 4: 39 bits, one put before them.
 */
static unsigned count_extended(const struct frame_bits *tables, const struct wire_frame *frame)
{
    struct stream_bits stream = {.tables = tables, .entry = state_of(1, 0)};
    bool remote = frame->flags & WIRE_REMOTE;
    unsigned length = remote ? 0 : frame->length;
    uint64_t header = (uint64_t)(frame->id >> 18) << 27 | 3u << 25 |
                      (uint64_t)(frame->id & 0x3FFFFu) << 7 | (remote ? 1u << 6 : 0) |
                      frame->length;
    add_bytes(&stream, header, header | EXTENDED_PAD, 5);
    add_data(&stream, frame->data, length);
    return UNSTUFFED_EXTENDED + 8u * length + count_stuffed(&stream);
}

static unsigned count_standard(const struct frame_bits *tables, const struct wire_frame *frame)
{
    struct stream_bits stream = {.tables = tables, .entry = state_of(1, 0)};
    bool remote = frame->flags & WIRE_REMOTE;
    unsigned length = remote ? 0 : frame->length;
    unsigned header = frame->id << 7 | (remote ? 1u << 6 : 0) | frame->length;
    add_bytes(&stream, header, header | HEADER_PAD, 3);
    add_data(&stream, frame->data, length);
    return UNSTUFFED + 8u * length + count_stuffed(&stream);
}

/*
 * Nominal and data bits: 33 + (34 + 10n) for n <= 16, 33 + (39 + 10n) above; 18 identifier bits
 * more, with their stuffing, when it is extended.
 */
static unsigned count_fd(const struct wire_frame *frame)
{
    unsigned bits = 33 + (frame->length <= 16 ? 34u : 39u) + 10u * frame->length;
    return bits + (frame->flags & WIRE_EXTENDED ? 25 : 0) - FRAME_BITS_INTERMISSION;
}

unsigned frame_bits_count_wire(const struct frame_bits *tables, const struct wire_frame *frame)
{
    if (frame->flags & WIRE_FD)
        return count_fd(frame);
    return frame->flags & WIRE_EXTENDED ? count_extended(tables, frame)
                                        : count_standard(tables, frame);
}

/* Bits as they are sent, with stuffing. */
struct bit_writer {
    uint8_t *level;
    unsigned count, run;
};

static void put_level(struct bit_writer *writer, uint8_t level)
{
    bool is_same = writer->count > 0 && writer->level[writer->count - 1] == level;
    writer->run = is_same ? writer->run + 1 : 1;
    writer->level[writer->count++] = level;
}

/* The lowest bits of value, the highest of them first. */
static void put_bits(struct bit_writer *writer, unsigned value, unsigned bits)
{
    while (bits-- > 0) {
        uint8_t level = value >> bits & 1;
        put_level(writer, level);
        if (writer->run == RUN_TO_STUFF)
            put_level(writer, !level);
    }
}

/* Delimiter, acknowledge (which receivers make dominant), delimiter, seven bits of end of frame. */
static const uint8_t end_of_frame[] = {1, 0, 1, 1, 1, 1, 1, 1, 1, 1};

unsigned frame_bits_levels(const struct frame_bits *tables, const struct can_frame *frame,
                           uint8_t level[FRAME_BITS_MAX])
{
    struct bit_writer writer = {.level = level};
    unsigned header = header_of(frame);
    unsigned checksum = 0;
    for (unsigned shift = 24; shift > 0; shift -= 8)
        checksum = add_checksum(tables, checksum, header >> (shift - 8));
    put_bits(&writer, header, HEADER_BITS);
    for (unsigned i = 0; i < can_data_length(frame); i++) {
        checksum = add_checksum(tables, checksum, frame->data[i]);
        put_bits(&writer, frame->data[i], 8);
    }
    put_bits(&writer, checksum >> 1, 15);
    memcpy(level + writer.count, end_of_frame, sizeof end_of_frame);
    return writer.count;
}

unsigned frame_bits_worst(unsigned length)
{
    /*
     * Davis, Burns, Bril, Lukkien: Controller Area Network schedulability analysis, Real-Time
     * Systems 35 (2007)
     */
    return 55 + 10 * length;
}
