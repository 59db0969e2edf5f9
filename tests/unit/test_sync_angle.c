/*
 * The spindle's angle out of its encoder's counts.
 */
#include "base/maths.h"
#include "sync/angle.h"

#include <unity.h>

#define SETTLED 400

static struct angle angle;

void setUp(void)
{
    takt_angle_init(&angle);
    takt_angle_tune(&angle, 0.1);
}

void tearDown(void)
{
}

/*
 * A spindle of this speed and acceleration at cycle k, its angle in whole counts of 1/counts; 0:
 * exact.
 */
static double rev_at(double k, double speed, double acceleration, double counts)
{
    const double rev = 7.0 + k * (speed + 0.5 * k * acceleration);

    return counts > 0.0 ? takt_maths_floor(rev * counts) / counts : rev;
}

static void measure(int cycles, double speed, double acceleration, double counts)
{
    for (int k = 0; k < cycles; k++) {
        angle_measure(&angle, rev_at(k, speed, acceleration, counts));
    }
}

static void test_a_constant_speed_is_known_exactly(void)
{
    measure(SETTLED, 0.01, 0.0, 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, rev_at(SETTLED - 1, 0.01, 0.0, 0.0), angle.rev);
    TEST_ASSERT_DOUBLE_WITHIN(1e-11, 0.01, angle.speed);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, rev_at(SETTLED + 4, 0.01, 0.0, 0.0),
                              takt_angle_look_ahead(&angle, 5.0).rev);
}

static void test_a_constant_acceleration_puts_nothing_off(void)
{
    measure(SETTLED, -0.02, 1e-4, 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, rev_at(SETTLED - 1, -0.02, 1e-4, 0.0), angle.rev);
    TEST_ASSERT_DOUBLE_WITHIN(1e-11, 1e-4, angle.acceleration);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, rev_at(SETTLED + 1, -0.02, 1e-4, 0.0),
                              takt_angle_look_ahead(&angle, 2.0).rev);
}

/* Counts of 1/100 at 1/137 a cycle: single readings say 0 or 0.01 a cycle. */
static void test_counts_are_smoothed(void)
{
    measure(SETTLED, 1.0 / 137.0, 0.0, 100.0);
    for (int k = SETTLED; k < 2 * SETTLED; k++) {
        angle_measure(&angle, rev_at(k, 1.0 / 137.0, 0.0, 100.0));
        TEST_ASSERT_DOUBLE_WITHIN(0.0005, 1.0 / 137.0, angle.speed);
        TEST_ASSERT_DOUBLE_WITHIN(0.01, rev_at(k, 1.0 / 137.0, 0.0, 0.0), angle.rev);
    }
}

static void test_the_first_reading_is_where_it_stands(void)
{
    angle_measure(&angle, 123456.75);
    TEST_ASSERT_EQUAL_DOUBLE(123456.75, angle.rev);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, angle.speed);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_constant_speed_is_known_exactly);
    RUN_TEST(test_a_constant_acceleration_puts_nothing_off);
    RUN_TEST(test_counts_are_smoothed);
    RUN_TEST(test_the_first_reading_is_where_it_stands);
    return UNITY_END();
}
