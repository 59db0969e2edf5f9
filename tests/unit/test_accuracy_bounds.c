#include "accuracy/bounds.h"
#include "base/maths.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_a_line_in_n_axes_leaves_its_way_by_less_than_root_n_minus_1_steps(void)
{
    TEST_ASSERT_EQUAL_DOUBLE(0.0, takt_bounds_line_off_mm(1, 0.01));
    TEST_ASSERT_EQUAL_DOUBLE(0.01, takt_bounds_line_off_mm(2, 0.01));
    TEST_ASSERT_EQUAL_DOUBLE(0.02, takt_bounds_line_off_mm(5, 0.01));
}

static void test_a_path_of_n_axes_is_root_n_times_as_fast_as_an_axis(void)
{
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 100.0, takt_bounds_axis_speed_mm_s(0.001, 1e5));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 200.0, takt_bounds_path_speed_mm_s(4, 0.001, 1e5));
}

/*
 * The sum by hand of the recurrence V += trunc(a), S += trunc(V): each cycle of a ramp costs one
 * unit more.
 */
static void test_truncation_adds_up_as_the_recurrence_does(void)
{
    for (unsigned half = 0; half < 30; half += 4) {
        const unsigned ramp = 2 * half;
        struct bounds_cycles n = {ramp, 13, half};
        double v = 0, s = 0;

        for (unsigned i = 0; i < ramp; i++) {
            v += 1;
            s += v;
        }
        v = 1; /* set to its exact value, but for its last bit */
        s += 13 * v;
        for (unsigned i = 0; i < half; i++) {
            v += 1;
            s += v;
        }
        TEST_ASSERT_EQUAL_DOUBLE(s, takt_bounds_truncation_ulp(&n));
    }
}

static void test_words_hold_what_they_are_for(void)
{
    TEST_ASSERT_EQUAL_UINT(0, takt_bounds_fraction_bits(0.5));
    TEST_ASSERT_EQUAL_UINT(1, takt_bounds_fraction_bits(1.0));
    TEST_ASSERT_EQUAL_UINT(10, takt_bounds_fraction_bits(1023.0));
    TEST_ASSERT_EQUAL_UINT(11, takt_bounds_fraction_bits(1024.0));
    TEST_ASSERT_EQUAL_UINT(8, takt_bounds_word_bits(127.0));
    TEST_ASSERT_EQUAL_UINT(9, takt_bounds_word_bits(-128.0));
}

static void test_a_turn_by_rotation_runs_ahead_by_a_third_of_pi_r_angle_squared(void)
{
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, MATHS_PI * 10.0 * 1e-4 / 3.0,
                              takt_bounds_rotation_along_mm(10.0, 0.01, MATHS_TWO_PI));
    /* V^2 / R = a: R dphi^2 = a dt^2 */
    TEST_ASSERT_DOUBLE_WITHIN(
        1e-15, takt_bounds_rotation_turn_mm(1000.0, 0.001),
        takt_bounds_rotation_along_mm(10.0, maths_sqrt(1000.0 * 1e-6 / 10.0), -MATHS_TWO_PI));
}

static void test_a_turn_by_rotation_grows_by_a_quarter_of_pi_r_angle_cubed(void)
{
    double page = MATHS_PI * 10.0 * 1e-6 / 4.0;

    TEST_ASSERT_DOUBLE_WITHIN(page * 1e-6, page,
                              takt_bounds_rotation_growth_mm(10.0, 0.01, MATHS_TWO_PI));
    /* The page's figure is the first term of a series: what really happens is above it. */
    TEST_ASSERT_TRUE(takt_bounds_rotation_growth_mm(10.0, 0.01, MATHS_TWO_PI) > page);
}

static void test_growth_over_very_many_turns_is_still_bounded(void)
{
    double grown = 10.0 * (takt_maths_exp(1e4 * 0.125e-3) - 1.0);

    TEST_ASSERT_DOUBLE_WITHIN(1e-9, grown, takt_bounds_rotation_growth_mm(10.0, 0.1, 1e4));
}

static void test_a_ramp_takes_speed_over_acceleration_cycles(void)
{
    TEST_ASSERT_EQUAL_DOUBLE(100.0, takt_bounds_ramp_cycles(100.0, 1000.0, 0.001));
    TEST_ASSERT_EQUAL_DOUBLE(101.0, takt_bounds_ramp_cycles(100.1, 1000.0, 0.001));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_line_in_n_axes_leaves_its_way_by_less_than_root_n_minus_1_steps);
    RUN_TEST(test_a_path_of_n_axes_is_root_n_times_as_fast_as_an_axis);
    RUN_TEST(test_truncation_adds_up_as_the_recurrence_does);
    RUN_TEST(test_words_hold_what_they_are_for);
    RUN_TEST(test_a_turn_by_rotation_runs_ahead_by_a_third_of_pi_r_angle_squared);
    RUN_TEST(test_a_turn_by_rotation_grows_by_a_quarter_of_pi_r_angle_cubed);
    RUN_TEST(test_growth_over_very_many_turns_is_still_bounded);
    RUN_TEST(test_a_ramp_takes_speed_over_acceleration_cycles);
    return UNITY_END();
}
