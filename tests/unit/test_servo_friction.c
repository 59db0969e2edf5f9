/* Friction as a table over velocity. */
#include "base/maths.h"
#include "servo/friction.h"

#include <unity.h>

static struct friction friction;

void setUp(void)
{
    friction = (struct friction){.points_per_velocity = 0.1, .at = {3, 2, 2, 4, 4, 5, 6, 8}};
}

void tearDown(void)
{
}

static void test_nothing_at_standstill(void)
{
    TEST_ASSERT_EQUAL_DOUBLE(0, takt_friction_at(&friction, 0));
    TEST_ASSERT_EQUAL_DOUBLE(0, takt_friction_at(&friction, -0.0));
}

static void test_the_first_point_where_motion_begins(void)
{
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 3, takt_friction_at(&friction, 1e-12));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -3, takt_friction_at(&friction, -1e-12));
}

static void test_straight_between_points(void)
{
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2.5, takt_friction_at(&friction, 5));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2, takt_friction_at(&friction, 10));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 3, takt_friction_at(&friction, 25));
}

static void test_the_last_point_beyond(void)
{
    TEST_ASSERT_EQUAL_DOUBLE(8, takt_friction_at(&friction, 70));
    TEST_ASSERT_EQUAL_DOUBLE(8, takt_friction_at(&friction, 1e300));
    TEST_ASSERT_EQUAL_DOUBLE(-8, takt_friction_at(&friction, -MATHS_INFINITY));
}

static void test_the_same_either_way(void)
{
    for (unsigned i = 0; i < 250; i++)
        TEST_ASSERT_EQUAL_DOUBLE(-takt_friction_at(&friction, 0.37 * i),
                                 takt_friction_at(&friction, -0.37 * i));
}

static void test_without_a_step_the_first_point_counts_everywhere(void)
{
    friction.points_per_velocity = 0;
    TEST_ASSERT_EQUAL_DOUBLE(3, takt_friction_at(&friction, 1e9));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_nothing_at_standstill);
    RUN_TEST(test_the_first_point_where_motion_begins);
    RUN_TEST(test_straight_between_points);
    RUN_TEST(test_the_last_point_beyond);
    RUN_TEST(test_the_same_either_way);
    RUN_TEST(test_without_a_step_the_first_point_counts_everywhere);
    return UNITY_END();
}
