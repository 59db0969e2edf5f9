/* What corrections of an axis take of its limits: the sum of what each takes. */
#include "correction/need.h"
#include "unity.h"

static const struct motion_bound most = {
    .velocity_mm_s = {100.0, 80.0},
    .acceleration_mm_s2 = {1000.0, 600.0},
    .jerk_mm_s3 = {50000.0, 20000.0},
};

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_slopes_by_several_axes_add_up_in_the_one_that_they_correct(void)
{
    struct need need = {.size_mm = {0.0}};

    takt_need_add_slope(&need, AXIS_Z, AXIS_X, 0.25, &most);
    takt_need_add_slope(&need, AXIS_Z, AXIS_Y, 0.5, &most);
    TEST_ASSERT_EQUAL_DOUBLE(25.0 + 40.0, need.velocity_mm_s[AXIS_Z]);
    TEST_ASSERT_EQUAL_DOUBLE(250.0 + 300.0, need.acceleration_mm_s2[AXIS_Z]);
    TEST_ASSERT_EQUAL_DOUBLE(12500.0 + 10000.0, need.jerk_mm_s3[AXIS_Z]);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, need.acceleration_mm_s2[AXIS_X]);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, need.acceleration_mm_s2[AXIS_Y]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_slopes_by_several_axes_add_up_in_the_one_that_they_correct);
    return UNITY_END();
}
