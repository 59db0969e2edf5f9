#include "port/line_ring.h"
#include "unity.h"

#define GAP_US 1750U

static struct line_ring ring;

void setUp(void)
{
    takt_line_ring_open(&ring, GAP_US);
}

void tearDown(void)
{
}

static void expect_byte(uint8_t byte, bool after_silence)
{
    bool silent;

    TEST_ASSERT_FALSE(takt_line_ring_is_empty(&ring));
    TEST_ASSERT_EQUAL_UINT8(byte, takt_line_ring_take(&ring, &silent));
    TEST_ASSERT_EQUAL(after_silence, silent);
}

static void test_bytes_come_out_in_their_order_with_the_silences_between_them(void)
{
    TEST_ASSERT_TRUE(takt_line_ring_is_empty(&ring));
    TEST_ASSERT_TRUE(takt_line_ring_put(&ring, 0x12, 10000));
    TEST_ASSERT_TRUE(takt_line_ring_put(&ring, 0xFF, 10000 + GAP_US - 1));
    TEST_ASSERT_TRUE(takt_line_ring_put(&ring, 0x34, 10000 + 2 * GAP_US - 1));
    expect_byte(0x12, true);
    expect_byte(0xFF, false);
    expect_byte(0x34, true);
    TEST_ASSERT_TRUE(takt_line_ring_is_empty(&ring));
}

static void test_a_full_ring_loses_the_newest_byte(void)
{
    for (unsigned i = 0; i < LINE_RING_MAX; i++)
        TEST_ASSERT_TRUE(takt_line_ring_put(&ring, (uint8_t)i, i));
    TEST_ASSERT_FALSE(takt_line_ring_put(&ring, 99, 99));
    expect_byte(0, true);
    TEST_ASSERT_TRUE(takt_line_ring_put(&ring, 100, 1000));
}

static void test_a_silence_before_a_lost_byte_stands_before_the_next_that_finds_room(void)
{
    for (unsigned i = 0; i < LINE_RING_MAX; i++)
        TEST_ASSERT_TRUE(takt_line_ring_put(&ring, (uint8_t)i, i));
    TEST_ASSERT_FALSE(takt_line_ring_put(&ring, 99, 1000 + GAP_US));
    expect_byte(0, true);
    TEST_ASSERT_TRUE(takt_line_ring_put(&ring, 100, 1100 + GAP_US));
    for (unsigned i = 1; i < LINE_RING_MAX; i++)
        expect_byte((uint8_t)i, false);
    expect_byte(100, true);
}

static void test_the_silence_before_each_byte_stays_its_own_however_often_the_ring_goes_round(void)
{
    uint32_t now_us = 0;
    uint32_t taken = 0;

    for (uint32_t i = 0; i < 5U * LINE_RING_MAX; i++) {
        now_us += i % 7 == 3 ? GAP_US : 100;
        TEST_ASSERT_TRUE(takt_line_ring_put(&ring, (uint8_t)i, now_us));
        for (; i % 16 == 15 && taken <= i; taken++)
            expect_byte((uint8_t)taken, taken == 0 || taken % 7 == 3);
    }
}

static void test_the_line_is_silent_when_the_gap_is_over_and_all_is_taken(void)
{
    bool silent;

    TEST_ASSERT_TRUE(takt_line_ring_put(&ring, 1, 5000));
    TEST_ASSERT_FALSE(takt_line_ring_is_silent(&ring, 5000 + GAP_US));
    (void)takt_line_ring_take(&ring, &silent);
    TEST_ASSERT_FALSE(takt_line_ring_is_silent(&ring, 5000 + GAP_US - 1));
    TEST_ASSERT_TRUE(takt_line_ring_is_silent(&ring, 5000 + GAP_US));
}

static void test_silences_survive_the_end_of_the_clock(void)
{
    TEST_ASSERT_TRUE(takt_line_ring_put(&ring, 1, UINT32_MAX - 5));
    TEST_ASSERT_TRUE(takt_line_ring_put(&ring, 2, 10));
    expect_byte(1, true);
    expect_byte(2, false);
    TEST_ASSERT_FALSE(takt_line_ring_is_silent(&ring, GAP_US));
    TEST_ASSERT_TRUE(takt_line_ring_is_silent(&ring, 10 + GAP_US));
}

/*
 * The interrupt's clock may be ahead of the background's: such a byte has not been silent for an
 * hour.
 */
static void test_a_byte_from_the_future_has_come_now(void)
{
    bool silent;

    TEST_ASSERT_TRUE(takt_line_ring_put(&ring, 1, 5000));
    (void)takt_line_ring_take(&ring, &silent);
    TEST_ASSERT_FALSE(takt_line_ring_is_silent(&ring, 4100));
}

static void test_a_clock_that_steps_back_makes_no_silence(void)
{
    TEST_ASSERT_TRUE(takt_line_ring_put(&ring, 1, 5000));
    TEST_ASSERT_TRUE(takt_line_ring_put(&ring, 2, 4100));
    expect_byte(1, true);
    expect_byte(2, false);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_bytes_come_out_in_their_order_with_the_silences_between_them);
    RUN_TEST(test_a_full_ring_loses_the_newest_byte);
    RUN_TEST(test_a_silence_before_a_lost_byte_stands_before_the_next_that_finds_room);
    RUN_TEST(test_the_silence_before_each_byte_stays_its_own_however_often_the_ring_goes_round);
    RUN_TEST(test_the_line_is_silent_when_the_gap_is_over_and_all_is_taken);
    RUN_TEST(test_silences_survive_the_end_of_the_clock);
    RUN_TEST(test_a_byte_from_the_future_has_come_now);
    RUN_TEST(test_a_clock_that_steps_back_makes_no_silence);
    return UNITY_END();
}
