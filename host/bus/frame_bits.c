/*
 * A data frame, bit by bit:
 *
 *     | start 0 | identifier 11 | RTR 0 | IDE 0 | r0 0 | length 4 | data 8n | CRC 15 | end 10 |
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

/* x^15 + x^14 + x^10 + x^8 + x^7 + x^4 + x^3 + 1, aligned to the upper 15 bits of 16. */
#define POLYNOMIAL (0x4599u << 1)

#define HEADER_PAD   0xA80000u /* 10101, then 19 zeros */
#define UNSTUFFED    44u       /* start to end without data: 34 + 10 */
#define RUN_TO_STUFF 5
#define STUFFED_STEP 16u /* one stuffed bit in an entry of the table */

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

unsigned frame_bits_count(const struct frame_bits *tables, const struct can_frame *frame)
{
    unsigned header = (unsigned)frame->id << 7 | frame->length;
    unsigned checksum = 0, entry = state_of(1, 0);
    for (unsigned shift = 24; shift > 0; shift -= 8) {
        checksum = add_checksum(tables, checksum, header >> (shift - 8));
        entry = add_stuffing(tables, entry, (header | HEADER_PAD) >> (shift - 8));
    }
    for (unsigned i = 0; i < frame->length; i++) {
        checksum = add_checksum(tables, checksum, frame->data[i]);
        entry = add_stuffing(tables, entry, frame->data[i]);
    }
    checksum |= ~checksum >> 1 & 1u;
    entry = add_stuffing(tables, entry, checksum >> 8);
    entry = add_stuffing(tables, entry, checksum);
    return UNSTUFFED + 8u * frame->length + entry / STUFFED_STEP;
}

unsigned frame_bits_worst(unsigned length)
{
    /*
     * Davis, Burns, Bril, Lukkien: Controller Area Network schedulability analysis, Real-Time
     * Systems 35 (2007)
     */
    return 55 + 10 * length;
}
