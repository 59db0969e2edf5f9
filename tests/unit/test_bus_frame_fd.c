/*
 * Frames of CAN FD against a frame of this file, made bit by bit as ISO 11898-1:2015, 10.4.2 tells
 * it: a list of fields, each bit with the rate at which it is sent, stuffed when all is there.
 */
#include "bus/frame_bits.h"
#include "bus/frame_levels.h"
#include "unity.h"

#include <string.h>

static struct frame_bits tables;
static uint64_t state;

void setUp(void)
{
    frame_bits_init(&tables);
    state = 27;
}

void tearDown(void)
{
}

static uint32_t draw(uint32_t range)
{
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(state >> 33) % range;
}

/* Half of the bytes are of equal bits, which are stuffed. */
static void draw_data(uint8_t *data, unsigned length)
{
    static const uint8_t bytes[] = {0x00, 0xFF, 0x0F, 0x83, 0x7C, 0xE0};
    for (unsigned i = 0; i < length; i++)
        data[i] = draw(3) ? bytes[draw(6)] : (uint8_t)draw(256);
}

struct naive {
    char bit[800], fast[800]; /* '0' or '1'; is it sent at the data rate? */
    unsigned count;
};

static void add(struct naive *n, unsigned value, unsigned bits, bool is_fast)
{
    for (unsigned mask = 1u << (bits - 1); bits > 0 && mask > 0; mask >>= 1) {
        n->bit[n->count] = value & mask ? '1' : '0';
        n->fast[n->count++] = is_fast ? 1 : 0;
    }
}

/*
 * Bits of all but the last five are followed by another one: a run of five at the end is not
 * stuffed.
 */
static unsigned stuff(const struct naive *plain, struct naive *stuffed)
{
    unsigned added = 0;
    stuffed->count = 0;
    for (unsigned i = 0; i < plain->count; i++) {
        stuffed->bit[stuffed->count] = plain->bit[i];
        stuffed->fast[stuffed->count++] = plain->fast[i];
        stuffed->bit[stuffed->count] = '\0';
        const char *end = stuffed->count < 5 ? "" : stuffed->bit + stuffed->count - 5;
        bool is_run = strcmp(end, "00000") == 0 || strcmp(end, "11111") == 0;
        if (!is_run || i + 1 == plain->count)
            continue;
        stuffed->bit[stuffed->count] = *end == '0' ? '1' : '0';
        stuffed->fast[stuffed->count++] = plain->fast[i];
        added++;
    }
    return added;
}

/* Long division, bit by bit, of the bits behind a one. */
static unsigned divide(const struct naive *n, unsigned degree, uint32_t polynomial)
{
    uint32_t remainder = 1u << (degree - 1);
    for (unsigned i = 0; i < n->count; i++) {
        bool carry = remainder >> (degree - 1) & 1;
        remainder = (remainder << 1) & ((1u << degree) - 1);
        if (carry != (n->bit[i] == '1'))
            remainder ^= polynomial & ((1u << degree) - 1);
    }
    return remainder;
}

/* The stuff count with its parity as the standard lists them. */
static const unsigned stuff_counts[] = {0x0, 0x3, 0x6, 0x5, 0xC, 0xF, 0xA, 0x9};

static void make_naive(const struct wire_frame *frame, struct naive *n)
{
    static const unsigned lengths[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};
    bool is_long = frame->length > 16, switches = frame->flags & WIRE_RATE_SWITCH;
    unsigned dlc = 0, crc_bits = is_long ? 21 : 17;
    struct naive plain = {.count = 0};
    while (lengths[dlc] < frame->length)
        dlc++;
    add(&plain, 0, 1, false);
    if (frame->flags & WIRE_EXTENDED) {
        add(&plain, frame->id >> 18, 11, false);
        add(&plain, 3, 2, false); /* SRR, IDE */
        add(&plain, frame->id & 0x3FFFF, 18, false);
        add(&plain, 0, 1, false); /* RRS */
    } else {
        add(&plain, frame->id, 11, false);
        add(&plain, 0, 2, false); /* RRS, IDE */
    }
    add(&plain, 2, 2, false); /* FDF, res */
    add(&plain, switches, 1, false);
    add(&plain, (frame->flags & WIRE_PASSIVE) != 0, 1, switches);
    add(&plain, dlc, 4, switches);
    for (unsigned i = 0; i < frame->length; i++)
        add(&plain, frame->data[i], 8, switches);
    unsigned stuffed = stuff(&plain, n);
    struct naive summed = *n;
    add(&summed, stuff_counts[stuffed % 8], 4, switches);
    unsigned crc = divide(&summed, crc_bits, is_long ? 0x302899 : 0x3685B);
    add(&summed, crc, crc_bits, switches);
    for (unsigned i = 0, first = n->count; i < 4 + crc_bits; i++) {
        if (i % 4 == 0)
            add(n, n->count > 0 && n->bit[n->count - 1] == '0', 1, switches);
        add(n, summed.bit[first + i] == '1', 1, switches);
    }
    add(n, 1, 1, switches); /* delimiter of the CRC */
    add(n, 0x1FF & ~0x100u, 9, false);
}

static struct wire_frame draw_frame(void)
{
    struct wire_frame frame = {.length = wire_frame_fd_length(draw(65))};
    frame.flags = (uint8_t)(WIRE_FD | (draw(2) ? WIRE_EXTENDED : 0) |
                            (draw(4) ? WIRE_RATE_SWITCH : 0) | (draw(8) ? 0 : WIRE_PASSIVE));
    frame.id = draw(frame.flags & WIRE_EXTENDED ? 0x20000000u : 0x800u);
    if (draw(2)) /* runs in identifiers */
        frame.id = frame.flags & WIRE_EXTENDED ? 0x1F00F83Eu & ~(draw(16) << 8) : 0x7C1u ^ draw(4);
    draw_data(frame.data, frame.length);
    return frame;
}

static void test_20000_random_frames_are_as_long_as_bit_by_bit(void)
{
    for (unsigned i = 0; i < 20000; i++) {
        struct wire_frame frame = draw_frame();
        struct frame_length length = frame_bits_count_wire(&tables, &frame);
        struct naive n;
        unsigned fast = 0;
        make_naive(&frame, &n);
        for (unsigned k = 0; k < n.count; k++)
            fast += n.fast[k] != 0;
        TEST_ASSERT_EQUAL_UINT(fast, length.data);
        TEST_ASSERT_EQUAL_UINT(n.count - fast, length.nominal);
    }
}

static void test_the_levels_of_a_frame_are_those_bit_by_bit(void)
{
    for (unsigned i = 0; i < 20000; i++) {
        struct can_frame frame = {.id = (uint16_t)draw(0x800),
                                  .length = wire_frame_fd_length(draw(65))};
        struct wire_frame wire;
        struct frame_levels levels;
        struct naive n;
        draw_data(frame.data, frame.length);
        wire_frame_from_can(&wire, &frame, true);
        make_naive(&wire, &n);
        frame_levels_set(&levels, &frame, true);
        TEST_ASSERT_EQUAL_UINT(n.count, levels.count);
        TEST_ASSERT_TRUE(levels.count <= FRAME_LEVELS_MAX);
        for (unsigned k = 0; k < n.count; k++) {
            TEST_ASSERT_EQUAL_INT(n.bit[k] == '1', levels.level[k]);
            TEST_ASSERT_EQUAL_INT(n.fast[k], k >= levels.data_begin && k < levels.data_end);
        }
    }
}

static void test_no_frame_is_longer_than_worst(void)
{
    for (unsigned i = 0; i < 20000; i++) {
        struct can_frame frame = {.id = (uint16_t)draw(0x800),
                                  .length = wire_frame_fd_length(draw(65))};
        struct frame_length worst = frame_bits_worst(frame.length, true);
        draw_data(frame.data, frame.length);
        struct frame_length length = frame_bits_count_port(&tables, &frame, true);
        TEST_ASSERT_TRUE(length.nominal + FRAME_BITS_INTERMISSION <= worst.nominal);
        TEST_ASSERT_TRUE(length.data <= worst.data);
    }
}

/* Every bit goes on with the run, and behind a stuffed one with that. */
static void fill_with_runs(struct can_frame *frame)
{
    unsigned run = 1, value = 0; /* ESI */
    for (unsigned at = 0; at < 4 + 8u * frame->length; at++) {
        unsigned bit = at < 4 ? wire_frame_fd_code(frame->length) >> (3 - at) & 1 : value;
        run = bit == value ? run + 1 : 1;
        value = bit;
        if (at >= 4)
            frame->data[(at - 4) / 8] |= (uint8_t)(bit << (7 - (at - 4) % 8));
        if (run == 5) {
            value = !value;
            run = 1;
        }
    }
}

/*
 * 078: stuffed behind 00000, 1111 and 0000. Where the length's code ends a run too soon a stuffed
 * bit is missing.
 */
static void test_the_worst_frame_is_as_long_as_the_formula_says_but_for_one_bit_of_some_codes(void)
{
    static const unsigned codes_one_less =
        1u << 1 | 1u << 2 | 1u << 5 | 1u << 6 | 1u << 9 | 1u << 10 | 1u << 13 | 1u << 14;
    for (unsigned n = 0; n <= 64; n = n < 64 ? wire_frame_fd_length(n + 1) : 65) {
        struct can_frame frame = {.id = 0x078, .length = (uint8_t)n};
        fill_with_runs(&frame);
        struct frame_length length = frame_bits_count_port(&tables, &frame, true);
        struct frame_length worst = frame_bits_worst(n, true);
        TEST_ASSERT_EQUAL_UINT(worst.nominal, length.nominal + FRAME_BITS_INTERMISSION);
        TEST_ASSERT_EQUAL_UINT(worst.data - (codes_one_less >> wire_frame_fd_code(n) & 1),
                               length.data);
    }
}

static void test_worst_lengths_are_those_of_the_formula(void)
{
    for (unsigned n = 0; n <= 64; n = n < 64 ? wire_frame_fd_length(n + 1) : 65) {
        struct frame_length worst = frame_bits_worst(n, true);
        TEST_ASSERT_EQUAL_UINT(32, worst.nominal);
        TEST_ASSERT_EQUAL_UINT((n > 16 ? 38 : 33) + 10 * n, worst.data);
    }
}

/* A remote frame has no form of CAN FD. */
static void test_a_remote_frame_is_classical_on_any_bus(void)
{
    struct can_frame frame = {.id = CAN_REMOTE | 0x701, .length = 1};
    struct frame_length length = frame_bits_count_port(&tables, &frame, true);
    TEST_ASSERT_EQUAL_UINT(frame_bits_count(&tables, &frame), length.nominal);
    TEST_ASSERT_EQUAL_UINT(0, length.data);
}

static void test_every_length_has_its_code_and_none_is_between(void)
{
    static const unsigned lengths[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};
    for (unsigned code = 0; code < 16; code++)
        TEST_ASSERT_EQUAL_UINT(code, wire_frame_fd_code(lengths[code]));
    for (unsigned n = 0; n <= 64; n++) {
        unsigned code = 0;
        while (lengths[code] < n)
            code++;
        TEST_ASSERT_EQUAL_UINT(lengths[code], wire_frame_fd_length(n));
    }
    TEST_ASSERT_EQUAL_UINT(64, wire_frame_fd_length(255));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_20000_random_frames_are_as_long_as_bit_by_bit);
    RUN_TEST(test_the_levels_of_a_frame_are_those_bit_by_bit);
    RUN_TEST(test_no_frame_is_longer_than_worst);
    RUN_TEST(test_the_worst_frame_is_as_long_as_the_formula_says_but_for_one_bit_of_some_codes);
    RUN_TEST(test_worst_lengths_are_those_of_the_formula);
    RUN_TEST(test_a_remote_frame_is_classical_on_any_bus);
    RUN_TEST(test_every_length_has_its_code_and_none_is_between);
    return UNITY_END();
}
