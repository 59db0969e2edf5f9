#include "bus/frame_bits.h"
#include "unity.h"

#include <stdbool.h>

static struct frame_bits tables;

void setUp(void)
{
    frame_bits_init(&tables);
}

void tearDown(void)
{
}

/*
 * The frame as single bits, checksum and stuffing done one bit after the other as the standard
 * tells them.
 */
struct bit_stream {
    bool bit[160];
    unsigned count;
};

static void put_bits(struct bit_stream *stream, unsigned value, unsigned count)
{
    while (count-- > 0)
        stream->bit[stream->count++] = value >> count & 1;
}

static unsigned reference_checksum(const struct bit_stream *stream)
{
    unsigned checksum = 0;
    for (unsigned i = 0; i < stream->count; i++) {
        bool next = stream->bit[i] ^ (checksum >> 14 & 1);
        checksum = checksum << 1 & 0x7FFF;
        if (next)
            checksum ^= 0x4599;
    }
    return checksum;
}

static unsigned reference_stuffed(const struct bit_stream *stream)
{
    unsigned stuffed = 0, run = 0;
    bool last = false;
    for (unsigned i = 0; i < stream->count; i++) {
        run = run > 0 && stream->bit[i] == last ? run + 1 : 1;
        last = stream->bit[i];
        if (run == 5) {
            stuffed++;
            last = !last;
            run = 1;
        }
    }
    return stuffed;
}

static unsigned reference_bits(const struct can_frame *frame)
{
    struct bit_stream stream = {.count = 0};
    put_bits(&stream, 0, 1);
    bool is_remote = (frame->id & CAN_REMOTE) != 0;
    put_bits(&stream, frame->id & 0x7FF, 11);
    put_bits(&stream, is_remote, 1);
    put_bits(&stream, 0, 2);
    put_bits(&stream, frame->length, 4);
    for (unsigned i = 0; i < frame->length && !is_remote; i++)
        put_bits(&stream, frame->data[i], 8);
    put_bits(&stream, reference_checksum(&stream), 15);
    /* checksum delimiter, acknowledge and its delimiter, seven bits of end */
    return stream.count + reference_stuffed(&stream) + 1 + 2 + 7;
}

static uint32_t seed;

static uint32_t lcg(void)
{
    seed = seed * 1664525u + 1013904223u;
    return seed >> 8;
}

/* Half of the bytes are 00 or FF: random bytes alone are hardly ever stuffed. */
static uint8_t random_byte(void)
{
    static const uint8_t extremes[] = {0x00, 0xFF};
    uint32_t dice = lcg();
    return dice & 0x100 ? extremes[dice >> 9 & 1] : (uint8_t)dice;
}

static struct can_frame random_frame(void)
{
    struct can_frame frame = {.id = (uint16_t)(lcg() & 0x7FF), .length = (uint8_t)(lcg() % 9)};
    for (unsigned i = 0; i < frame.length; i++)
        frame.data[i] = random_byte();
    return frame;
}

static void test_100000_random_frames_are_as_long_as_bit_by_bit(void)
{
    seed = 7;
    for (unsigned i = 0; i < 100000; i++) {
        struct can_frame frame = random_frame();
        TEST_ASSERT_EQUAL_UINT(reference_bits(&frame), frame_bits_count(&tables, &frame));
    }
}

static void test_every_identifier_without_data_is_as_long_as_bit_by_bit(void)
{
    for (unsigned id = 0; id < 0x800; id++) {
        struct can_frame frame = {.id = (uint16_t)id};
        TEST_ASSERT_EQUAL_UINT(reference_bits(&frame), frame_bits_count(&tables, &frame));
    }
}

static void test_remote_frames_have_no_data_and_are_as_long_as_bit_by_bit(void)
{
    seed = 13;
    for (unsigned i = 0; i < 20000; i++) {
        struct can_frame frame = random_frame();
        frame.id |= CAN_REMOTE;
        TEST_ASSERT_EQUAL_UINT(reference_bits(&frame), frame_bits_count(&tables, &frame));
    }
}

static void test_no_frame_is_shorter_than_unstuffed_or_longer_than_worst(void)
{
    seed = 11;
    for (unsigned i = 0; i < 100000; i++) {
        struct can_frame frame = random_frame();
        unsigned bits = frame_bits_count(&tables, &frame) + FRAME_BITS_INTERMISSION;
        TEST_ASSERT_TRUE(bits >= 47u + 8u * frame.length);
        TEST_ASSERT_TRUE(bits <= frame_bits_worst(frame.length, false).nominal);
    }
}

static void test_worst_lengths_are_those_of_the_analysis(void)
{
    TEST_ASSERT_EQUAL_UINT(55, frame_bits_worst(0, false).nominal);
    TEST_ASSERT_EQUAL_UINT(115, frame_bits_worst(6, false).nominal);
    TEST_ASSERT_EQUAL_UINT(125, frame_bits_worst(7, false).nominal);
    TEST_ASSERT_EQUAL_UINT(135, frame_bits_worst(8, false).nominal);
    for (unsigned n = 0; n <= 8; n++)
        TEST_ASSERT_EQUAL_UINT(47 + 8 * n + (34 + 8 * n - 1) / 4,
                               frame_bits_worst(n, false).nominal);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_100000_random_frames_are_as_long_as_bit_by_bit);
    RUN_TEST(test_remote_frames_have_no_data_and_are_as_long_as_bit_by_bit);
    RUN_TEST(test_every_identifier_without_data_is_as_long_as_bit_by_bit);
    RUN_TEST(test_no_frame_is_shorter_than_unstuffed_or_longer_than_worst);
    RUN_TEST(test_worst_lengths_are_those_of_the_analysis);
    return UNITY_END();
}
