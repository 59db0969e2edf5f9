/*
 * The figures of seed 000. They stand in the units of the paper: mm/min, mm, increments/mm, Hz;
 * m/s3 for jerk.
 */
#include "accuracy/cycle_frequency.h"
#include "base/maths.h"
#include "unity.h"

#define STANDARD_GRAVITY_MM_S2 9806.65

void setUp(void)
{
}

void tearDown(void)
{
}

static double chord_error_um(double radius_mm, double feed_mm_min, double frequency_hz)
{
    return 1000.0 * takt_cycle_chord_error_mm(radius_mm,
                                              takt_cycle_step_mm(feed_mm_min / 60.0, frequency_hz));
}

static struct cycle_need need_of(double feed_mm_min, double gravities, double jerk_m_s3)
{
    struct cycle_limits limits = {feed_mm_min / 60.0, gravities * STANDARD_GRAVITY_MM_S2,
                                  jerk_m_s3 * 1000.0};
    struct cycle_need need;

    takt_cycle_frequency_find(&limits, 0.001, &need);
    return need;
}

static void test_a_cycle_at_200_hz_steps_0_4167_mm_and_leaves_a_circle_by_21_942_um(void)
{
    TEST_ASSERT_DOUBLE_WITHIN(0.00005, 0.4167, takt_cycle_step_mm(5000.0 / 60.0, 200.0));
    TEST_ASSERT_DOUBLE_WITHIN(0.0005, 21.942, chord_error_um(1.0, 5000.0, 200.0));
}

static void test_a_cycle_at_2000_hz_steps_0_0417_mm_and_leaves_a_circle_by_0_2170_um(void)
{
    TEST_ASSERT_DOUBLE_WITHIN(0.00005, 0.0417, takt_cycle_step_mm(5000.0 / 60.0, 2000.0));
    TEST_ASSERT_DOUBLE_WITHIN(0.00005, 0.2170, chord_error_um(1.0, 5000.0, 2000.0));
}

static void test_1000_hz_keep_a_micrometre_on_a_circle_of_1_mm(void)
{
    TEST_ASSERT_TRUE(chord_error_um(1.0, 5000.0, 1000.0) < 1.0);
}

static void test_the_chord_error_of_a_large_circle_does_not_cancel(void)
{
    /* h^2 / (8 R) to first order; R - sqrt(R^2 - h^2/4) would be 0 here. */
    TEST_ASSERT_DOUBLE_WITHIN(1e-24, 1e-6 * 1e-6 / 8e6, takt_cycle_chord_error_mm(1e6, 1e-6));
}

static void test_a_step_beyond_the_diameter_is_off_by_the_radius(void)
{
    TEST_ASSERT_EQUAL_DOUBLE(2.0, takt_cycle_chord_error_mm(2.0, 4.0));
    TEST_ASSERT_EQUAL_DOUBLE(2.0, takt_cycle_chord_error_mm(2.0, 100.0));
}

static void test_circles_no_larger_than_the_tolerance_need_no_frequency_and_no_lower_feed(void)
{
    TEST_ASSERT_EQUAL_DOUBLE(0.0, takt_cycle_frequency_hz(0.001, 100.0, 0.001));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, takt_cycle_frequency_hz(0.0001, 100.0, 0.001));
    TEST_ASSERT_TRUE(takt_cycle_feed_chord_mm_s(0.001, 1000.0, 0.001) == MATHS_INFINITY);
    TEST_ASSERT_TRUE(takt_cycle_feed_chord_mm_s(0.0004, 1000.0, 0.001) == MATHS_INFINITY);
}

static void test_feed_by_chord_error_is_the_frequency_turned_round(void)
{
    for (unsigned n = 0; n < 15; n++) {
        double radius = 0.0011 * takt_maths_power(3.0, n);
        double frequency = takt_cycle_frequency_hz(radius, 77.0, 0.001);

        TEST_ASSERT_DOUBLE_WITHIN(1e-11, 77.0,
                                  takt_cycle_feed_chord_mm_s(radius, frequency, 0.001));
        TEST_ASSERT_DOUBLE_WITHIN(
            1e-15, 0.001, takt_cycle_chord_error_mm(radius, takt_cycle_step_mm(77.0, frequency)));
    }
}

static void test_a_tenth_of_g_needs_350_hz_without_a_feed_limit(void)
{
    struct cycle_limits limits = {MATHS_INFINITY, 0.1 * STANDARD_GRAVITY_MM_S2, 5000.0};
    struct cycle_need need;

    takt_cycle_frequency_find(&limits, 0.001, &need);
    TEST_ASSERT_DOUBLE_WITHIN(0.5, 350.0, need.frequency_hz);
    TEST_ASSERT_EQUAL_UINT(CYCLE_LIMIT_ACCELERATION | CYCLE_LIMIT_JERK, need.limits);
    TEST_ASSERT_DOUBLE_WITHIN(5.0, 11540.0, need.feed_mm_s * 60.0);
}

static void test_one_g_needs_1107_hz_without_a_feed_limit_and_not_the_1170_printed(void)
{
    struct cycle_limits limits = {MATHS_INFINITY, STANDARD_GRAVITY_MM_S2, 50000.0};
    struct cycle_need need;

    takt_cycle_frequency_find(&limits, 0.001, &need);
    TEST_ASSERT_DOUBLE_WITHIN(0.5, 1107.0, need.frequency_hz);
    TEST_ASSERT_DOUBLE_WITHIN(1.0, 115404.0, need.feed_mm_s * 60.0);
}

/*
 * f = sqrt(a / (8 d)) where the tolerance is small beside the radius at which jerk and acceleration
 * meet.
 */
static void test_the_plateau_does_not_depend_on_jerk(void)
{
    double plateau = maths_sqrt(0.1 * STANDARD_GRAVITY_MM_S2 / 0.008);

    for (unsigned times = 1; times <= 10; times++) {
        struct cycle_need need = need_of(20000.0, 0.1, 5.0 * times);

        TEST_ASSERT_DOUBLE_WITHIN(plateau * 0.02, plateau, need.frequency_hz);
    }
}

static void test_the_five_machines_need_111_122_157_297_and_313_hz(void)
{
    TEST_ASSERT_DOUBLE_WITHIN(0.5, 111.0, need_of(1000.0, 0.01, 5.0).frequency_hz);
    TEST_ASSERT_DOUBLE_WITHIN(0.5, 122.0, need_of(1500.0, 0.012, 5.0).frequency_hz);
    TEST_ASSERT_DOUBLE_WITHIN(0.5, 157.0, need_of(4500.0, 0.02, 5.0).frequency_hz);
    TEST_ASSERT_DOUBLE_WITHIN(0.5, 297.0, need_of(6000.0, 0.1, 5.0).frequency_hz);
    TEST_ASSERT_DOUBLE_WITHIN(0.5, 313.0, need_of(7500.0, 0.08, 5.0).frequency_hz);
    TEST_ASSERT_EQUAL_UINT(CYCLE_LIMIT_FEED | CYCLE_LIMIT_JERK, need_of(6000.0, 0.1, 5.0).limits);
}

static void test_on_the_ma655_jerk_meets_feed_at_40_mm_and_acceleration_at_55_mm(void)
{
    const double jerk = 625.0;
    const double acceleration = takt_maths_cbrt(55.0 * jerk * jerk); /* R = a^3 / J^2 */
    struct cycle_limits limits = {100.0, acceleration, jerk};
    unsigned governing;

    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 100.0, takt_cycle_feed_jerk_mm_s(40.0, jerk));
    TEST_ASSERT_TRUE(acceleration / STANDARD_GRAVITY_MM_S2 > 0.02 &&
                     acceleration / STANDARD_GRAVITY_MM_S2 < 0.1);
    (void)takt_cycle_feed_allowed_mm_s(&limits, 40.0, &governing);
    TEST_ASSERT_EQUAL_UINT(CYCLE_LIMIT_FEED | CYCLE_LIMIT_JERK, governing);
    limits.feed_mm_s = MATHS_INFINITY;
    (void)takt_cycle_feed_allowed_mm_s(&limits, 55.0, &governing);
    TEST_ASSERT_EQUAL_UINT(CYCLE_LIMIT_ACCELERATION | CYCLE_LIMIT_JERK, governing);
}

/*
 * Above the tolerance nothing needs more than the frequency found, by a scan that knows no
 * branches.
 */
static void test_no_circle_needs_more_than_the_highest_need(void)
{
    static const double feeds[] = {1.0, 1000.0, 7500.0, 1e6};
    static const double gravities[] = {0.0001, 0.01, 1.0};
    static const double jerks[] = {0.005, 5.0, 5000.0};

    for (unsigned i = 0; i < 36; i++) {
        struct cycle_limits limits = {feeds[i % 4] / 60.0,
                                      gravities[i / 4 % 3] * STANDARD_GRAVITY_MM_S2,
                                      jerks[i / 12] * 1000.0};
        struct cycle_need need;
        double highest = 0.0;

        takt_cycle_frequency_find(&limits, 0.001, &need);
        for (unsigned n = 0; n < 30000; n++) {
            double radius = 0.001 * (1.0 + 1e-9) * takt_maths_exp(0.001 * n);
            double feed = takt_cycle_feed_allowed_mm_s(&limits, radius, NULL);

            highest = maths_max(highest, takt_cycle_frequency_hz(radius, feed, 0.001));
        }
        TEST_ASSERT_TRUE(highest <= need.frequency_hz * (1.0 + 1e-9));
        TEST_ASSERT_TRUE(highest >= need.frequency_hz * 0.999);
    }
}

static void test_a_limit_that_is_infinite_does_not_count(void)
{
    struct cycle_limits limits = {100.0, MATHS_INFINITY, MATHS_INFINITY};
    struct cycle_need need;

    takt_cycle_frequency_find(&limits, 0.001, &need);
    TEST_ASSERT_EQUAL_DOUBLE(0.001, need.radius_mm); /* the smallest circle, at full feed */
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 50000.0, need.frequency_hz);
    TEST_ASSERT_EQUAL_UINT(CYCLE_LIMIT_FEED, need.limits);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_cycle_at_200_hz_steps_0_4167_mm_and_leaves_a_circle_by_21_942_um);
    RUN_TEST(test_a_cycle_at_2000_hz_steps_0_0417_mm_and_leaves_a_circle_by_0_2170_um);
    RUN_TEST(test_1000_hz_keep_a_micrometre_on_a_circle_of_1_mm);
    RUN_TEST(test_the_chord_error_of_a_large_circle_does_not_cancel);
    RUN_TEST(test_a_step_beyond_the_diameter_is_off_by_the_radius);
    RUN_TEST(test_circles_no_larger_than_the_tolerance_need_no_frequency_and_no_lower_feed);
    RUN_TEST(test_feed_by_chord_error_is_the_frequency_turned_round);
    RUN_TEST(test_a_tenth_of_g_needs_350_hz_without_a_feed_limit);
    RUN_TEST(test_one_g_needs_1107_hz_without_a_feed_limit_and_not_the_1170_printed);
    RUN_TEST(test_the_plateau_does_not_depend_on_jerk);
    RUN_TEST(test_the_five_machines_need_111_122_157_297_and_313_hz);
    RUN_TEST(test_on_the_ma655_jerk_meets_feed_at_40_mm_and_acceleration_at_55_mm);
    RUN_TEST(test_no_circle_needs_more_than_the_highest_need);
    RUN_TEST(test_a_limit_that_is_infinite_does_not_count);
    return UNITY_END();
}
