/* How much of a curve a mm of path is. */
#include "base/maths.h"
#include "plan/junction.h"
#include "plan/path_unit.h"
#include "plan/scale.h"

#include <string.h>
#include <unity.h>

static struct plan_limits limits;

void setUp(void)
{
    limits = (struct plan_limits){.axes = 63, .cycle_s = 1e-3, .chord_error_max_mm = 1e-3};
    for (int i = 0; i < AXIS_COUNT; i++) {
        limits.velocity_mm_s[i] = i < AXIS_LINEAR_COUNT ? 100.0 : MATHS_PI;
        limits.acceleration_mm_s2[i] = 10.0 * limits.velocity_mm_s[i];
        limits.jerk_mm_s3[i] = 500.0 * limits.velocity_mm_s[i];
    }
}

void tearDown(void)
{
}

static struct block block_to(double x_mm, double a_rad, double feed_mm_s)
{
    const struct move m = {
        .kind = MOVE_FEED, .feed_mm_s = feed_mm_s, .end = {{x_mm, 0.0, 0.0, a_rad}}};
    const struct point start = {{0.0}};
    struct curve c;
    struct block b;

    TEST_ASSERT_TRUE(takt_move_curve(&m, &start, &c));
    takt_block_set_motion(&b, &m, &c, &limits);
    return b;
}

static void test_the_path_is_as_long_as_the_longer_way_of_linear_and_rotary_axes(void)
{
    TEST_ASSERT_EQUAL_DOUBLE(10.0, block_to(10.0, 0.0, 1.0).length_mm);
    TEST_ASSERT_EQUAL_DOUBLE(10.0, block_to(10.0, 9.0, 1.0).length_mm);
    TEST_ASSERT_EQUAL_DOUBLE(9.0, block_to(0.0, 9.0, 1.0).length_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-14, 9.0, block_to(1e-9, 9.0, 1.0).length_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-14, 9.0, block_to(1.0, 9.0, 1.0).length_mm);
}

static void test_the_programmed_time_stays_what_it_is(void)
{
    for (int decade = -8; decade < 3; decade++) {
        const double x_mm = takt_maths_power(10.0, decade);
        const struct block b = block_to(x_mm, 9.0, x_mm / 5.0);

        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 5.0, b.length_mm / b.feed_program_mm_s);
    }
}

static void test_a_turn_has_the_same_limits_beside_any_short_way(void)
{
    const struct block alone = block_to(0.0, 9.0, 1.0);

    for (int decade = -8; decade < 0; decade++) {
        const struct block b = block_to(takt_maths_power(10.0, decade), 9.0, 1.0);

        TEST_ASSERT_DOUBLE_WITHIN(1e-12, alone.feed_cap_mm_s, b.feed_cap_mm_s);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, alone.a_mm_s2, b.a_mm_s2);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, alone.j_mm_s3, b.j_mm_s3);
        TEST_ASSERT_INT64_WITHIN(16, (int64_t)alone.length, (int64_t)b.length);
    }
}

static void test_a_unit_does_not_show_in_the_jerk_of_a_slow_axis(void)
{
    TEST_ASSERT_EQUAL_DOUBLE(1.0, takt_scale_of_machine(&limits).linear);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, takt_scale_of_machine(&limits).rotary);
    for (int i = 0; i < 7; i++) {
        const double jerk = 1e3 * takt_maths_power(3.0, -i);

        limits.jerk_mm_s3[AXIS_C] = jerk;
        const double unit = takt_scale_of_machine(&limits).rotary / PATH_UNITS_PER_MM;

        TEST_ASSERT_TRUE(unit <= jerk * 1e-9 / 65536.0);
    }
}

/*
 * A second difference is off by 2 units, and 16 where one is put on an end: 1e-4 of the limit at
 * most.
 */
static void test_nor_in_its_acceleration(void)
{
    limits.jerk_mm_s3[AXIS_C] = 1e6;
    for (int i = 0; i < 7; i++) {
        const double a = 10.0 * takt_maths_power(3.0, -i);

        limits.acceleration_mm_s2[AXIS_C] = a;
        const double unit = takt_scale_of_machine(&limits).rotary / PATH_UNITS_PER_MM;

        TEST_ASSERT_TRUE(18.0 * unit <= 1e-4 * a * 1e-6);
    }
}

static void test_nor_does_it_beside_linear_axes_that_leave_no_room_for_smaller_ones(void)
{
    limits.profile = RAMP_PROFILE_GENTLE;
    limits.velocity_mm_s[AXIS_Y] = 20000.0;
    limits.jerk_mm_s3[AXIS_C] = 1.0;
    const struct scale s = takt_scale_of_machine(&limits);
    const double turn = block_to(1.0, 1e3, 1.0).scale;

    TEST_ASSERT_TRUE(s.rotary / PATH_UNITS_PER_MM <= 1.0 * 1e-9 / 65536.0);
    TEST_ASSERT_TRUE(s.linear > s.rotary);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, s.rotary / 1e3, turn);
    TEST_ASSERT_EQUAL_DOUBLE(s.linear, block_to(1.0, 0.0, 1.0).scale);
}

static void test_sums_over_the_longest_window_stay_within_64_bits(void)
{
    static const enum ramp_profile profiles[] = {RAMP_PROFILE_JERK, RAMP_PROFILE_SMOOTH,
                                                 RAMP_PROFILE_GENTLE};

    limits.cycle_s = 4e-3;
    limits.velocity_mm_s[AXIS_Y] = 20000.0;
    for (unsigned i = 0; i < 3; i++) {
        const uint32_t cycles = takt_ramp_profile_cycles_max(profiles[i]);
        double sum =
            0.5 * 80.0 * PATH_UNITS_PER_MM * takt_ramp_profile_window_cycles(profiles[i], cycles);

        limits.profile = profiles[i];
        for (unsigned box = 0; box < takt_ramp_profile_boxes(profiles[i]); box++) {
            sum *= takt_ramp_profile_box_cycles(box, cycles);
        }
        TEST_ASSERT_TRUE(sum / takt_scale_of_machine(&limits).linear < 9223372036854775808.0);
    }
}

/* One axis, and limits of powers of two, so that nothing is rounded. */
static void test_a_sum_that_is_one_too_many_for_64_bits_takes_the_next_scale(void)
{
    const uint32_t cycles = takt_ramp_profile_cycles_max(RAMP_PROFILE_JERK);
    const double sum = 0.5 * PATH_UNITS_PER_MM * (double)cycles * (double)cycles;

    limits.axes = 1U << AXIS_X;
    limits.cycle_s = 1.0 / 1024.0;
    limits.velocity_mm_s[AXIS_X] = 9223372036854775808.0 / sum * 1024.0;
    limits.acceleration_mm_s2[AXIS_X] = 1e9;
    limits.jerk_mm_s3[AXIS_X] = 1e12;
    TEST_ASSERT_EQUAL_DOUBLE(2.0, takt_scale_of_machine(&limits).linear);
    limits.velocity_mm_s[AXIS_X] *= 1.0 - 1e-12;
    TEST_ASSERT_EQUAL_DOUBLE(1.0, takt_scale_of_machine(&limits).linear);
}

static void test_the_longest_way_fits_into_path_positions(void)
{
    TEST_ASSERT_INT64_WITHIN(1024, SCALE_LENGTH_UNITS, block_to(1e100, 0.0, 1.0).length);
    TEST_ASSERT_INT64_WITHIN(1024, SCALE_LENGTH_UNITS, block_to(1e-9, 1e18, 1.0).length);
}

/*
 * The trapezoidal reference would come to it too late, and be beyond it before the setpoint has
 * slowed down.
 */
static void test_what_is_far_slower_than_a_cycle_of_braking_is_come_to_at_rest(void)
{
    struct block fast = block_to(10.0, 0.0, 50.0);
    struct block slow = block_to(1e-6, 0.0, 1e-5);

    takt_junction_form(&fast, &slow, &limits);
    TEST_ASSERT_EQUAL(JUNCTION_STOP, fast.end);
    slow = block_to(10.0, 0.0, 1.0);
    takt_junction_form(&fast, &slow, &limits);
    TEST_ASSERT_EQUAL(JUNCTION_PASSED, fast.end);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_path_is_as_long_as_the_longer_way_of_linear_and_rotary_axes);
    RUN_TEST(test_the_programmed_time_stays_what_it_is);
    RUN_TEST(test_a_turn_has_the_same_limits_beside_any_short_way);
    RUN_TEST(test_a_unit_does_not_show_in_the_jerk_of_a_slow_axis);
    RUN_TEST(test_nor_in_its_acceleration);
    RUN_TEST(test_nor_does_it_beside_linear_axes_that_leave_no_room_for_smaller_ones);
    RUN_TEST(test_sums_over_the_longest_window_stay_within_64_bits);
    RUN_TEST(test_a_sum_that_is_one_too_many_for_64_bits_takes_the_next_scale);
    RUN_TEST(test_the_longest_way_fits_into_path_positions);
    RUN_TEST(test_what_is_far_slower_than_a_cycle_of_braking_is_come_to_at_rest);
    return UNITY_END();
}
