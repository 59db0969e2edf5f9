/*
 * A classical frame is drawn in frame_bits.c. One of CAN FD, ISO 11898-1:2015, 10.4.2:
 *
 *     | start 0 | identifier 11 | RRS 0 | IDE 0 | FDF 1 | res 0 | BRS 1 | ESI 0 | DLC 4 | data 8n |
 *     |<------------------------------------- stuffed ------------------------------------------->|
 *
 *     | S | count 3, parity | S | 4 of the CRC | S | 4 ... | delimiter 1 | acknowledge, delimiter, end of frame |
 *
 * S: a fixed stuff bit, opposite to the bit before it; one before the stuff count, one behind every
 * four bits. It takes the place of a stuffed bit that the end of the data asks for. The count is
 * that of stuffed bits modulo 8, as a Gray code, with even parity. The CRC, of 17 bits up to 16
 * bytes and of 21 above, covers all bits before it, stuffed ones included, but not the fixed ones;
 * its register begins with a one at its upper end.
 */
#include "bus/frame_levels.h"

#include "bus/wire_frame.h"

#include <string.h>

#define RUN_TO_STUFF  5
#define FIXED_STUFF   4
#define CRC15         0x4599U /* of 15 bits, from 0 */
#define CRC17         0x1685BU
#define CRC21         0x102899U
#define SHORT_CRC_MAX 16 /* bytes that the shorter one covers */

struct writer {
    struct frame_levels *levels;
    unsigned run, stuffed;
    uint32_t crc, polynomial, top; /* top: the upper bit of its register */
    bool sums_stuffed;
};

static void put(struct writer *w, unsigned level)
{
    struct frame_levels *l = w->levels;
    bool is_same = l->count > 0 && l->level[l->count - 1] == level;
    w->run = is_same ? w->run + 1 : 1;
    l->level[l->count++] = (uint8_t)level;
}

static void sum(struct writer *w, unsigned level)
{
    bool is_one = ((w->crc & w->top) != 0) != (level != 0);
    w->crc = (w->crc << 1 ^ (is_one ? w->polynomial : 0)) & ((w->top << 1) - 1);
}

/* A bit opposite to the last, when five are equal. */
static void stuff(struct writer *w)
{
    if (w->run < RUN_TO_STUFF)
        return;
    const unsigned level = !w->levels->level[w->levels->count - 1];
    put(w, level);
    w->stuffed++;
    if (w->sums_stuffed)
        sum(w, level);
}

/*
 * The lowest bits of value, the highest of them first. What is due to be stuffed is so before the
 * next bit.
 */
static void put_bits(struct writer *w, unsigned value, unsigned bits)
{
    while (bits-- > 0) {
        stuff(w);
        put(w, value >> bits & 1);
        sum(w, value >> bits & 1);
    }
}

static void put_data(struct writer *w, const struct can_frame *frame, unsigned length)
{
    const unsigned given = can_data_length(frame);
    for (unsigned i = 0; i < length; i++)
        put_bits(w, i < given ? frame->data[i] : 0, 8);
}

/* Delimiter, acknowledge (which receivers make dominant), delimiter, seven bits of end of frame. */
static void put_end(struct writer *w)
{
    static const uint8_t end[] = {1, 0, 1, 1, 1, 1, 1, 1, 1, 1};
    memcpy(w->levels->level + w->levels->count, end, sizeof end);
    w->levels->count += (unsigned)sizeof end;
}

static void set_classical(struct frame_levels *levels, const struct can_frame *frame)
{
    struct writer w = {.levels = levels, .polynomial = CRC15, .top = 1U << 14};
    put_bits(&w, can_rank(frame->id) << 6 | frame->length, 19);
    put_data(&w, frame, can_data_length(frame));
    put_bits(&w, w.crc, 15);
    stuff(&w);
    levels->stuffed = levels->count;
    put_end(&w);
}

/*
 * Stuff count, its parity, and the CRC, which covers them: each four bits behind a fixed stuff bit.
 */
static void put_fixed(struct writer *w, unsigned crc_bits)
{
    const unsigned count = w->stuffed % 8, gray = count ^ count >> 1;
    const unsigned parity = (gray ^ gray >> 1 ^ gray >> 2) & 1, field = gray << 1 | parity;
    for (unsigned i = 4; i-- > 0;)
        sum(w, field >> i & 1);
    const uint32_t all = field << crc_bits | w->crc;
    for (unsigned i = 0; i < 4 + crc_bits; i++) {
        if (i % FIXED_STUFF == 0)
            put(w, !w->levels->level[w->levels->count - 1]);
        put(w, all >> (3 + crc_bits - i) & 1);
    }
}

static void set_fd(struct frame_levels *levels, const struct can_frame *frame)
{
    const unsigned length = wire_frame_fd_length(frame->length);
    const bool is_short = length <= SHORT_CRC_MAX;
    const unsigned crc_bits = is_short ? 17 : 21;
    struct writer w = {.levels = levels,
                       .polynomial = is_short ? CRC17 : CRC21,
                       .top = 1U << (crc_bits - 1),
                       .sums_stuffed = true};
    w.crc = w.top;
    put_bits(&w, (frame->id & CAN_ID_MASK) << 5 | 5U, 17);
    levels->data_begin = levels->count;
    put_bits(&w, wire_frame_fd_code(length), 5);
    put_data(&w, frame, length);
    levels->stuffed = levels->count;
    put_fixed(&w, crc_bits);
    put_end(&w);
    levels->data_end = levels->count - 9; /* behind the delimiter of the CRC */
}

void frame_levels_set(struct frame_levels *levels, const struct can_frame *frame, bool fd)
{
    levels->count = levels->data_begin = levels->data_end = 0;
    if (fd && !can_is_remote(frame))
        set_fd(levels, frame);
    else
        set_classical(levels, frame);
}
