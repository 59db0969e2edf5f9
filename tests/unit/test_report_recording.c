#include "report/recording.h"

#include "base/maths.h"
#include "unity.h"

#define CYCLE_S 0.002

static const struct plan_limits limits = {
    .axes = 1u << AXIS_X | 1u << AXIS_B,
    .velocity_mm_s = {[AXIS_X] = 100.0, [AXIS_B] = 3.0},
    .acceleration_mm_s2 = {[AXIS_X] = 1000.0, [AXIS_B] = 30.0},
    .jerk_mm_s3 = {[AXIS_X] = 10000.0, [AXIS_B] = 300.0},
    .cycle_s = CYCLE_S,
};
enum { OF_X, OF_B };

static struct recording recording;
static struct thin_point point[THIN_POINTS_MAX];

void setUp(void)
{
    TEST_ASSERT_TRUE(recording_open(&recording, &limits));
}

void tearDown(void)
{
    recording_close(&recording);
}

static void add(uint64_t cycle, double x_mm, double b_rad)
{
    struct cycle_record record = {.cycle = cycle, .override_percent = 100.0, .limiter = 1.0};
    record.cmd.at[AXIS_X] = record.set.at[AXIS_X] = x_mm;
    record.cmd.at[AXIS_B] = record.set.at[AXIS_B] = b_rad;
    record.feed_mm_s = 2.0;
    recording_add(&recording, &record, false);
}

static unsigned get_axis(unsigned axis, enum axis_series series)
{
    return thin_get_points(&recording.thin, recording_axis_series(axis, series), point);
}

/* x = j t^3 / 6: the third difference is j at every cycle, exact but for rounding. */
static void test_the_jerk_of_a_cubic_is_its_third_derivative(void)
{
    for (uint64_t k = 0; k < 50; k++) {
        const double t = CYCLE_S * (double)k;
        add(k, 6000.0 * t * t * t / 6.0, 0.0);
    }
    TEST_ASSERT_EQUAL_UINT(47, get_axis(OF_X, AXIS_JERK));
    TEST_ASSERT_EQUAL_UINT32(3, point[0].cycle);
    for (unsigned i = 0; i < 47; i++)
        TEST_ASSERT_FLOAT_WITHIN(0.01F, 6000.0F, point[i].value);
}

static void test_differences_begin_where_enough_cycles_are_known(void)
{
    for (uint64_t k = 0; k < 10; k++)
        add(k, 0.1 * (double)k, 0.0);
    TEST_ASSERT_EQUAL_UINT(9, get_axis(OF_X, AXIS_VELOCITY));
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, 50.0F, point[0].value);
    TEST_ASSERT_EQUAL_UINT(8, get_axis(OF_X, AXIS_ACCELERATION));
    TEST_ASSERT_EQUAL_UINT(7, get_axis(OF_X, AXIS_JERK));
}

static void test_no_difference_reaches_over_a_gap(void)
{
    add(100, 0.0, 0.0);
    add(101, 0.1, 0.0);
    add(200, 50.0, 0.0);
    add(201, 50.1, 0.0);
    TEST_ASSERT_EQUAL_UINT(2, get_axis(OF_X, AXIS_VELOCITY));
    TEST_ASSERT_EQUAL_UINT32(1, point[0].cycle);
    TEST_ASSERT_EQUAL_UINT32(101, point[1].cycle);
    TEST_ASSERT_FLOAT_WITHIN(1e-3F, 50.0F, point[1].value);
}

static void test_rotary_axes_are_in_degrees(void)
{
    for (uint64_t k = 0; k < 4; k++)
        add(k, 0.0, (double)k * CYCLE_S * MATHS_PI);
    TEST_ASSERT_EQUAL_UINT(3, get_axis(OF_B, AXIS_VELOCITY));
    TEST_ASSERT_FLOAT_WITHIN(1e-3F, 180.0F, point[2].value);
}

/* The drive reports, DRIVES_LATENCY_CYCLES late, 0.5 mm less than it was sent. */
static void test_the_following_error_leaves_out_the_latency_of_the_bus(void)
{
    for (uint64_t k = 0; k < 20; k++) {
        struct cycle_record record = {.cycle = 1000 + k};
        record.set.at[AXIS_X] = 0.1 * (double)(k * k);
        if (k >= DRIVES_LATENCY_CYCLES) {
            const double sent = (double)((k - DRIVES_LATENCY_CYCLES) * (k - DRIVES_LATENCY_CYCLES));
            record.act.at[AXIS_X] = 0.1 * sent - 0.5;
        }
        recording_add(&recording, &record, false);
    }
    TEST_ASSERT_EQUAL_UINT(20 - DRIVES_LATENCY_CYCLES, get_axis(OF_X, AXIS_FOLLOWING));
    for (unsigned i = 0; i < 20 - DRIVES_LATENCY_CYCLES; i++)
        TEST_ASSERT_FLOAT_WITHIN(1e-5F, 0.5F, point[i].value);
}

static void test_the_feed_counts_degrees_when_rotary_axes_move_alone(void)
{
    add(0, 0.0, 0.0);
    add(1, 0.1, 0.1);
    add(2, 0.1, 0.2);
    TEST_ASSERT_EQUAL_UINT(3, thin_get_points(&recording.thin, RUN_FEED_MM_MIN, point));
    TEST_ASSERT_FLOAT_WITHIN(1e-3F, 120.0F, point[1].value);
    TEST_ASSERT_FLOAT_WITHIN(1e-2F, 6875.4936F, point[2].value); /* 2 rad/s in degrees a minute */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_jerk_of_a_cubic_is_its_third_derivative);
    RUN_TEST(test_differences_begin_where_enough_cycles_are_known);
    RUN_TEST(test_no_difference_reaches_over_a_gap);
    RUN_TEST(test_rotary_axes_are_in_degrees);
    RUN_TEST(test_the_following_error_leaves_out_the_latency_of_the_bus);
    RUN_TEST(test_the_feed_counts_degrees_when_rotary_axes_move_alone);
    return UNITY_END();
}
