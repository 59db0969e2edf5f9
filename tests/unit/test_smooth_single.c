#include "smooth/single.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_cube_roots_are_within_some_millionths_over_thirty_decades(void)
{
    float x = 1e-15f;

    while (x < 1e15f) {
        const double y = (double)takt_single_cbrt(x);

        TEST_ASSERT_TRUE(y * y * y > (double)x * (1.0 - 1e-5));
        TEST_ASSERT_TRUE(y * y * y < (double)x * (1.0 + 1e-5));
        x *= 1.37f;
    }
}

static void test_the_cube_root_of_nothing_is_nothing(void)
{
    TEST_ASSERT_TRUE(takt_single_cbrt(0.0f) == 0.0f);
    TEST_ASSERT_TRUE(takt_single_cbrt(-0.0f) == 0.0f);
}

static void test_clamping_gives_the_low_end_for_what_is_no_number(void)
{
    const float none = SINGLE_INFINITY - SINGLE_INFINITY;

    TEST_ASSERT_TRUE(single_clamp(none, -2.0f, 3.0f) == -2.0f);
    TEST_ASSERT_TRUE(single_clamp(-5.0f, -2.0f, 3.0f) == -2.0f);
    TEST_ASSERT_TRUE(single_clamp(5.0f, -2.0f, 3.0f) == 3.0f);
    TEST_ASSERT_TRUE(single_clamp(1.0f, -2.0f, 3.0f) == 1.0f);
}

static void test_halves_are_rounded_away_from_zero(void)
{
    TEST_ASSERT_EQUAL_INT(3, single_round(2.5f));
    TEST_ASSERT_EQUAL_INT(-3, single_round(-2.5f));
    TEST_ASSERT_EQUAL_INT(2, single_round(2.4375f));
    TEST_ASSERT_EQUAL_INT(0, single_round(-0.25f));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_cube_roots_are_within_some_millionths_over_thirty_decades);
    RUN_TEST(test_the_cube_root_of_nothing_is_nothing);
    RUN_TEST(test_clamping_gives_the_low_end_for_what_is_no_number);
    RUN_TEST(test_halves_are_rounded_away_from_zero);
    return UNITY_END();
}
