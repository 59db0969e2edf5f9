#include "canopen/time_stamp.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

/* Noon of 2 January 1984: 43,200,000 ms are 02932E00, in the order of the bus 00 2E 93 02. */
static void test_a_time_is_the_six_bytes_of_the_standard(void)
{
    static const uint8_t expected[] = {0x00, 0x2E, 0x93, 0x02, 0x01, 0x00};
    struct can_frame frame;
    const struct time_stamp time = {.ms = 43200000, .days = 1};
    struct time_stamp read;
    takt_time_stamp_write(&frame, &time);
    TEST_ASSERT_EQUAL_HEX16(0x100, frame.id);
    TEST_ASSERT_EQUAL_INT(6, frame.length);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, frame.data, 6);
    TEST_ASSERT_TRUE(takt_time_stamp_read(&frame, &read));
    TEST_ASSERT_EQUAL_UINT32(time.ms, read.ms);
    TEST_ASSERT_EQUAL_UINT(time.days, read.days);
}

static void test_reserved_bits_do_not_count_and_what_is_no_time_is_none(void)
{
    struct time_stamp time;
    struct can_frame frame = {.length = 6, .data = {0xFF, 0x5B, 0x26, 0xF5}};
    TEST_ASSERT_TRUE(takt_time_stamp_read(&frame, &time));
    TEST_ASSERT_EQUAL_UINT32(86399999, time.ms);
    frame.data[0] = 0;
    frame.data[1] = 0x5C;
    TEST_ASSERT_FALSE(takt_time_stamp_read(&frame, &time));
    frame.data[1] = 0;
    frame.length = 5;
    TEST_ASSERT_FALSE(takt_time_stamp_read(&frame, &time));
}

static void test_days_follow_from_milliseconds(void)
{
    const struct time_stamp late = {.ms = TIME_MS_PER_DAY - 1, .days = 9};
    struct time_stamp time = takt_time_stamp_add(late, 1 + UINT64_C(2) * TIME_MS_PER_DAY);
    TEST_ASSERT_EQUAL_UINT32(0, time.ms);
    TEST_ASSERT_EQUAL_UINT(12, time.days);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_time_is_the_six_bytes_of_the_standard);
    RUN_TEST(test_reserved_bits_do_not_count_and_what_is_no_time_is_none);
    RUN_TEST(test_days_follow_from_milliseconds);
    return UNITY_END();
}
