/* Blocks so near to rest that the setpoint stays below their ceiling by itself. */
#include "plan/rest.h"

#include "base/maths.h"
#include "plan_along_x.h"

#include <unity.h>

static struct ceiling ceiling;
static struct ceiling_request request;

void setUp(void)
{
    begin_path();
    request = (struct ceiling_request){.span = UINT64_MAX, .feed_ratio = 1.0, .rapid_ratio = 1.0};
}

void tearDown(void)
{
}

static void build(void)
{
    path_finish(&path);
    ceiling_build(&ceiling, &path, &request);
}

/*
 * The lead point speeds up by a without a pause: wherever it is, the setpoint is as fast as is told, but for what a cycle
 * more or less makes.
 */
static void check_way_up(double a, uint32_t cycles)
{
    double way[256];

    for (unsigned k = 0; k < 256; k++) {
        double at = 0.0;
        double before = 0.0;

        way[k] = 0.5 * a * k * k;
        for (unsigned i = 0; i < cycles && i < k; i++) {
            at += way[k - i] / cycles;
            before += way[k - i - 1] / cycles;
        }
        if (k > 4) {
            TEST_ASSERT_FALSE(rest_may_exceed(1.1 * (at - before) + a, at, a, cycles));
            TEST_ASSERT_TRUE(rest_may_exceed(0.9 * (at - before) - a, at, a, cycles));
        }
    }
}

static void test_it_is_as_fast_as_the_average_of_an_even_acceleration(void)
{
    check_way_up(0.001, 20);
    check_way_up(0.0004, 50);
    check_way_up(0.01, 3);
}

/* 0.03 mm from rest 5.9 mm/s are reached at most, 0.3 mm from it 27 mm/s. */
static void test_short_slow_blocks_at_both_ends_do_not_hold_up_the_lead_point(void)
{
    push(0.03, 10.0);
    push(10.0, 50.0);
    push(0.03, 10.0);
    build();
    TEST_ASSERT_EQUAL(1, ceiling.count);
    TEST_ASSERT_TRUE(ceiling.piece[0].feed_mm_s == 50.0F);
}

static void test_a_slow_block_that_the_setpoint_can_be_too_fast_in_keeps_its_ceiling(void)
{
    push(0.03, 5.0);
    push(10.0, 50.0);
    push(0.3, 10.0);
    build();
    TEST_ASSERT_EQUAL(3, ceiling.count);
    TEST_ASSERT_TRUE(ceiling.piece[0].feed_mm_s == 5.0F);
    TEST_ASSERT_TRUE(ceiling.piece[2].feed_mm_s == 10.0F);
}

/* The span was not begun at rest: its first block may be come to at any feed. */
static void test_a_block_behind_a_landed_joint_is_not_lifted(void)
{
    push(0.03, 10.0);
    push(10.0, 50.0);
    path_finish(&path);
    request.lead = path_at(&path, 0)->start + 1;
    request.span = path_at(&path, 0)->start;
    request.cycles = 20;
    request.rest_a = MATHS_INFINITY;
    ceiling_build(&ceiling, &path, &request);
    TEST_ASSERT_TRUE(ceiling.piece[0].feed_mm_s == 10.0F);
}

static void test_the_highest_feed_is_lifted_with_its_own_ceiling(void)
{
    push(0.03, 7.0);
    push(10.0, 50.0);
    build();
    TEST_ASSERT_TRUE(ceiling.piece[0].feed_mm_s == 7.0F);
    TEST_ASSERT_TRUE(ceiling.piece[0].feed_max_mm_s >= 59.9F);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_it_is_as_fast_as_the_average_of_an_even_acceleration);
    RUN_TEST(test_short_slow_blocks_at_both_ends_do_not_hold_up_the_lead_point);
    RUN_TEST(test_a_slow_block_that_the_setpoint_can_be_too_fast_in_keeps_its_ceiling);
    RUN_TEST(test_a_block_behind_a_landed_joint_is_not_lifted);
    RUN_TEST(test_the_highest_feed_is_lifted_with_its_own_ceiling);
    return UNITY_END();
}
