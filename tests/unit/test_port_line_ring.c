#include "port/line_ring.h"
#include "unity.h"

#include <string.h>

static struct line_ring ring;

void setUp(void)
{
    memset(&ring, 0, sizeof ring);
}

void tearDown(void)
{
}

static void test_bytes_come_out_in_their_order_with_their_times(void)
{
    uint32_t came_us;

    TEST_ASSERT_TRUE(line_ring_is_empty(&ring));
    TEST_ASSERT_TRUE(line_ring_put(&ring, 0x12, 1000));
    TEST_ASSERT_TRUE(line_ring_put(&ring, 0xFF, 1500));
    TEST_ASSERT_EQUAL_UINT8(0x12, line_ring_take(&ring, 2000, &came_us));
    TEST_ASSERT_EQUAL_UINT32(1000, came_us);
    TEST_ASSERT_EQUAL_UINT8(0xFF, line_ring_take(&ring, 2000, &came_us));
    TEST_ASSERT_EQUAL_UINT32(1500, came_us);
    TEST_ASSERT_TRUE(line_ring_is_empty(&ring));
}

static void test_a_full_ring_loses_the_newest_byte(void)
{
    uint32_t came_us;

    for (unsigned i = 0; i < LINE_RING_MAX; i++)
        TEST_ASSERT_TRUE(line_ring_put(&ring, (uint8_t)i, i));
    TEST_ASSERT_FALSE(line_ring_put(&ring, 99, 99));
    TEST_ASSERT_EQUAL_UINT8(0, line_ring_take(&ring, 1000, &came_us));
    TEST_ASSERT_TRUE(line_ring_put(&ring, 100, 1000));
}

static void test_times_survive_the_end_of_the_clock(void)
{
    uint32_t came_us;

    TEST_ASSERT_TRUE(line_ring_put(&ring, 1, UINT32_MAX - 5));
    (void)line_ring_take(&ring, 10, &came_us);
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX - 5, came_us);
}

/* The interrupt's clock may be ahead of the background's: such a byte has not been silent for 16 s. */
static void test_a_byte_from_the_future_has_come_now(void)
{
    uint32_t came_us;

    TEST_ASSERT_TRUE(line_ring_put(&ring, 1, 5000));
    (void)line_ring_take(&ring, 4100, &came_us);
    TEST_ASSERT_EQUAL_UINT32(4100, came_us);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_bytes_come_out_in_their_order_with_their_times);
    RUN_TEST(test_a_full_ring_loses_the_newest_byte);
    RUN_TEST(test_times_survive_the_end_of_the_clock);
    RUN_TEST(test_a_byte_from_the_future_has_come_now);
    return UNITY_END();
}
