/* The averaging boxes of each ramp profile. */
#include "plan/ramp_profile.h"

#include <unity.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_each_smoother_ramp_profile_has_one_box_more(void)
{
    TEST_ASSERT_EQUAL(1, takt_ramp_profile_boxes(RAMP_PROFILE_JERK));
    TEST_ASSERT_EQUAL(2, takt_ramp_profile_boxes(RAMP_PROFILE_SMOOTH));
    TEST_ASSERT_EQUAL(3, takt_ramp_profile_boxes(RAMP_PROFILE_GENTLE));
}

static void test_further_boxes_are_half_as_long_rounded_up(void)
{
    TEST_ASSERT_EQUAL(21, takt_ramp_profile_box_cycles(0, 21));
    TEST_ASSERT_EQUAL(11, takt_ramp_profile_box_cycles(1, 21));
    TEST_ASSERT_EQUAL(11, takt_ramp_profile_box_cycles(2, 21));
}

/* Boxes of n and m cycles one after the other reach over n + m - 1 inputs. */
static void test_the_window_is_what_all_boxes_reach_over(void)
{
    TEST_ASSERT_EQUAL(20, takt_ramp_profile_window_cycles(RAMP_PROFILE_JERK, 20));
    TEST_ASSERT_EQUAL(29, takt_ramp_profile_window_cycles(RAMP_PROFILE_SMOOTH, 20));
    TEST_ASSERT_EQUAL(38, takt_ramp_profile_window_cycles(RAMP_PROFILE_GENTLE, 20));
    TEST_ASSERT_EQUAL(1, takt_ramp_profile_window_cycles(RAMP_PROFILE_GENTLE, 1));
}

/* 2^38 units a mm times the product of the boxes leaves 2^63 room for 64 mm at least. */
static void test_sums_of_the_longest_boxes_stay_within_64_bits(void)
{
    for (int profile = RAMP_PROFILE_JERK; profile <= RAMP_PROFILE_GENTLE; profile++) {
        double product = 64.0 * 274877906944.0;

        for (unsigned i = 0; i < takt_ramp_profile_boxes((enum ramp_profile)profile); i++) {
            product *= takt_ramp_profile_box_cycles(
                i, takt_ramp_profile_cycles_max((enum ramp_profile)profile));
        }
        TEST_ASSERT_TRUE(product < 9223372036854775808.0);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_smoother_ramp_profile_has_one_box_more);
    RUN_TEST(test_further_boxes_are_half_as_long_rounded_up);
    RUN_TEST(test_the_window_is_what_all_boxes_reach_over);
    RUN_TEST(test_sums_of_the_longest_boxes_stay_within_64_bits);
    return UNITY_END();
}
