/* The moving average between trapezoidal reference and setpoint. */
#include "motion/average.h"

#include "plan/path_unit.h"

#include <unity.h>

static struct average average;

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_at_rest_nothing_lags(void)
{
    takt_average_start(&average, RAMP_PROFILE_GENTLE, 20, 12345, 0);
    TEST_ASSERT_TRUE(average_lag(&average) == 0.0);
}

/* Boxes of 20, 10 and 10 cycles: (19 + 9 + 9) / 2 cycles behind. */
static void test_at_constant_feed_it_follows_half_the_window_behind(void)
{
    takt_average_start(&average, RAMP_PROFILE_GENTLE, 20, 0, 1000);
    TEST_ASSERT_TRUE(average_lag(&average) == 18500.0);
    takt_average_push(&average, 1000);
    TEST_ASSERT_TRUE(average_lag(&average) == 18500.0);
}

/*
 * After a start of acceleration a, one box of N: jerk by differences is a/N for N cycles, then 0.
 */
static void test_one_box_spreads_a_step_of_acceleration_over_its_cycles(void)
{
    const uint64_t a = 1000;
    const int cycles = 10;
    uint64_t at = 0;
    double h[4] = {0.0};

    takt_average_start(&average, RAMP_PROFILE_JERK, (uint32_t)cycles, 0, 0);
    for (int i = 0; i < 30; i++) {
        at += (uint64_t)(i + 1) * a;
        takt_average_push(&average, at);
        h[3] = h[2];
        h[2] = h[1];
        h[1] = h[0];
        h[0] = (double)at - average_lag(&average);
        const double jerk = h[0] - 3.0 * h[1] + 3.0 * h[2] - h[3];

        TEST_ASSERT_DOUBLE_WITHIN(1e-6, i < cycles ? (double)a / cycles : 0.0, jerk);
    }
}

static void test_positions_may_wrap_around(void)
{
    takt_average_start(&average, RAMP_PROFILE_SMOOTH, 9, UINT64_MAX - 50, 100);
    takt_average_push(&average, (uint64_t)(UINT64_MAX - 50 + 100));
    TEST_ASSERT_TRUE(average_lag(&average) == 100.0 * 0.5 * (8 + 4));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_at_rest_nothing_lags);
    RUN_TEST(test_at_constant_feed_it_follows_half_the_window_behind);
    RUN_TEST(test_one_box_spreads_a_step_of_acceleration_over_its_cycles);
    RUN_TEST(test_positions_may_wrap_around);
    return UNITY_END();
}
