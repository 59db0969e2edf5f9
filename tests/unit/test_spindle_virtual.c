#include "base/maths.h"
#include "spindle/virtual_spindle.h"
#include "unity.h"

#include <string.h>

#define CYCLE_S 0.001

static struct virtual_spindle_config config;
static struct virtual_spindle spindle;
static struct spindle_feedback feedback;

void setUp(void)
{
    virtual_spindle_set_default(&config);
    virtual_spindle_init(&spindle, &config);
    memset(&feedback, 0, sizeof feedback);
}

void tearDown(void)
{
}

static void start_anew(void)
{
    TEST_ASSERT_NULL(virtual_spindle_check(&config));
    virtual_spindle_init(&spindle, &config);
}

static void run_for(double time_s, double commanded_rpm, double load_nm)
{
    const int cycles = (int)(time_s / CYCLE_S + 0.5);

    for (int i = 0; i < cycles; i++)
        feedback = virtual_spindle_step(&spindle, CYCLE_S, commanded_rpm, load_nm);
}

static double seconds_to_speed(double commanded_rpm)
{
    double time_s = 0;

    do {
        feedback = virtual_spindle_step(&spindle, CYCLE_S, commanded_rpm, 0);
        time_s += CYCLE_S;
    } while (!feedback.at_speed && time_s < 100);
    return time_s;
}

/* 12,000 rpm at 12,000 rpm/s, less the 2 % that count as at speed. */
static void test_it_is_at_speed_when_the_ramp_is(void)
{
    TEST_ASSERT_DOUBLE_WITHIN(0.03, 0.98, seconds_to_speed(12000));
    TEST_ASSERT_FALSE(virtual_spindle_step(&spindle, CYCLE_S, 20000, 0).at_speed);
}

/* From -s to s the ramp needs twice as long, through 0. */
static void test_a_reverse_passes_through_standstill(void)
{
    run_for(3, -6000, 0);
    TEST_ASSERT_DOUBLE_WITHIN(1, -6000, feedback.speed_rpm);
    run_for(0.5, 6000, 0);
    TEST_ASSERT_DOUBLE_WITHIN(60, 0, feedback.speed_rpm);
    run_for(2, 6000, 0);
    TEST_ASSERT_DOUBLE_WITHIN(1, 6000, feedback.speed_rpm);
    TEST_ASSERT_TRUE(feedback.at_speed);
}

/* At 6000 rpm ten seconds are 1000 revolutions; the ramp's half second takes 25 of them. */
static void test_the_angle_is_the_integral_of_the_speed(void)
{
    run_for(10, 6000, 0);
    TEST_ASSERT_DOUBLE_WITHIN(0.5, 975, feedback.angle_rev);
    run_for(10, -6000, 0);
    TEST_ASSERT_DOUBLE_WITHIN(1, 975 - 900, feedback.angle_rev);
}

static void test_the_angle_is_a_whole_number_of_counts(void)
{
    config.encoder_counts_per_revolution = 64;
    start_anew();
    for (int i = 0; i < 200; i++) {
        double counts;

        feedback = virtual_spindle_step(&spindle, CYCLE_S, 1000, 0);
        counts = feedback.angle_rev * 64;
        TEST_ASSERT_EQUAL_DOUBLE(takt_maths_floor(counts), counts);
    }
    TEST_ASSERT_GREATER_THAN(0, feedback.angle_rev);
}

/* Steady: the motor gives friction and load, 2e-5 N m s x 1256.6 rad/s + 0.4 N m of 0.875 N m. */
static void test_the_load_is_told_in_percent_of_the_rated_torque(void)
{
    run_for(5, 12000, 0.4);
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 100 * (2e-5 * 1256.637 + 0.4) / 0.875, feedback.load_percent);
}

/* Aluminium, 700 N/mm2, 5 mm wide, 2 mm deep, 50 mm/s: 350 W; at 12,000 rpm 0.2785 N m. */
static void test_a_cut_takes_the_torque_of_its_chips(void)
{
    config.cut_width_mm = 5;
    config.cut_depth_mm = 2;
    start_anew();
    TEST_ASSERT_EQUAL_DOUBLE(0, virtual_spindle_cut_nm(&spindle, 50, config.cut_depth_mm));
    run_for(3, 12000, 0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 350 / 1256.637,
                              virtual_spindle_cut_nm(&spindle, 50, config.cut_depth_mm));
}

static void test_the_torque_stays_within_its_limit_and_the_speed_gives_way(void)
{
    config.overload_s = 1000;
    start_anew();
    run_for(3, 12000, 0);
    for (int i = 0; i < 300; i++) {
        feedback = virtual_spindle_step(&spindle, CYCLE_S, 12000, 2.0);
        TEST_ASSERT_TRUE(feedback.load_percent <= config.torque_limit_percent * 1.000001);
    }
    TEST_ASSERT_FALSE(feedback.at_speed);
    TEST_ASSERT_LESS_THAN(9000, feedback.speed_rpm);
    run_for(3, 12000, 0);
    TEST_ASSERT_TRUE(feedback.at_speed);
}

static void test_an_overload_trips_after_its_time_and_not_before(void)
{
    config.overload_s = 2;
    start_anew();
    run_for(3, 12000, 0);
    run_for(1.9, 12000, 2.0);
    TEST_ASSERT_FALSE(feedback.tripped);
    run_for(0.3, 12000, 2.0);
    TEST_ASSERT_TRUE(feedback.tripped);
    TEST_ASSERT_FALSE(feedback.at_speed);
    TEST_ASSERT_EQUAL_INT(VIRTUAL_SPINDLE_OVERLOAD, spindle.trip);
}

static void test_a_tripped_spindle_runs_out_until_it_is_acknowledged(void)
{
    run_for(3, 12000, 0);
    virtual_spindle_set_trip(&spindle, VIRTUAL_SPINDLE_EXTERNAL);
    run_for(1, 12000, 0.1);
    TEST_ASSERT_TRUE(feedback.tripped);
    TEST_ASSERT_EQUAL_DOUBLE(0, feedback.load_percent);
    TEST_ASSERT_LESS_THAN(11900, feedback.speed_rpm);
    virtual_spindle_set_trip(&spindle, VIRTUAL_SPINDLE_GOOD);
    TEST_ASSERT_LESS_THAN(1, seconds_to_speed(12000));
}

static void test_a_locked_rotor_does_not_turn(void)
{
    spindle.locked = true;
    run_for(1, 12000, 0);
    TEST_ASSERT_EQUAL_DOUBLE(0, feedback.speed_rpm);
    TEST_ASSERT_EQUAL_DOUBLE(0, feedback.angle_rev);
    TEST_ASSERT_DOUBLE_WITHIN(0.1, config.torque_limit_percent, feedback.load_percent);
}

static void test_the_load_resists_and_never_drives(void)
{
    run_for(1, 0, 5.0);
    TEST_ASSERT_EQUAL_DOUBLE(0, feedback.speed_rpm);
    TEST_ASSERT_TRUE(feedback.at_speed);
}

static void test_long_and_short_steps_tell_the_same_story(void)
{
    struct virtual_spindle other = spindle;

    for (int i = 0; i < 100; i++)
        feedback = virtual_spindle_step(&spindle, 0.01, 8000, 0.2);
    for (int i = 0; i < 1000; i++)
        (void)virtual_spindle_step(&other, 0.001, 8000, 0.2);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, other.speed_rad_s, spindle.speed_rad_s);
}

static void test_a_value_out_of_range_is_named(void)
{
    TEST_ASSERT_NULL(virtual_spindle_check(&config));
    config.inertia_kg_m2 = 0;
    TEST_ASSERT_EQUAL_STRING("inertia_kg_m2", virtual_spindle_check(&config));
    config.inertia_kg_m2 = 1.0 / 0.0;
    TEST_ASSERT_EQUAL_STRING("inertia_kg_m2", virtual_spindle_check(&config));
}

static void test_ripple_swings_the_speed_as_often_as_it_is_told(void)
{
    double before_rpm = 0.0;
    int rises = 0;

    config.ripple_percent = 50;
    config.ripple_per_revolution = 3;
    start_anew();
    run_for(2, 600, 0);
    for (int i = 0; i < 1000; i++) { /* ten revolutions */
        run_for(CYCLE_S, 600, 0);
        rises += feedback.speed_rpm > 600 && before_rpm <= 600 ? 1 : 0;
        before_rpm = feedback.speed_rpm;
    }
    TEST_ASSERT_INT_WITHIN(1, 30, rises);
}

static void test_the_encoders_noise_is_within_its_counts_and_the_same_again(void)
{
    double first[200];

    config.encoder_counts_per_revolution = 1000;
    config.encoder_noise_counts = 2;
    for (int run = 0; run < 2; run++) {
        bool noisy = false;

        start_anew();
        for (int i = 0; i < 200; i++) {
            run_for(CYCLE_S, 600, 0);
            const double off = 1000 * (feedback.angle_rev - spindle.angle_rev);

            TEST_ASSERT_TRUE(off > -3.001 && off < 2.001);
            noisy = noisy || off > 0 || off < -1;
            first[i] = run == 0 ? feedback.angle_rev : first[i];
            TEST_ASSERT_EQUAL_DOUBLE(first[i], feedback.angle_rev);
        }
        TEST_ASSERT_TRUE(noisy);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_ripple_swings_the_speed_as_often_as_it_is_told);
    RUN_TEST(test_the_encoders_noise_is_within_its_counts_and_the_same_again);
    RUN_TEST(test_it_is_at_speed_when_the_ramp_is);
    RUN_TEST(test_a_reverse_passes_through_standstill);
    RUN_TEST(test_the_angle_is_the_integral_of_the_speed);
    RUN_TEST(test_the_angle_is_a_whole_number_of_counts);
    RUN_TEST(test_the_load_is_told_in_percent_of_the_rated_torque);
    RUN_TEST(test_a_cut_takes_the_torque_of_its_chips);
    RUN_TEST(test_the_torque_stays_within_its_limit_and_the_speed_gives_way);
    RUN_TEST(test_an_overload_trips_after_its_time_and_not_before);
    RUN_TEST(test_a_tripped_spindle_runs_out_until_it_is_acknowledged);
    RUN_TEST(test_a_locked_rotor_does_not_turn);
    RUN_TEST(test_the_load_resists_and_never_drives);
    RUN_TEST(test_long_and_short_steps_tell_the_same_story);
    RUN_TEST(test_a_value_out_of_range_is_named);
    return UNITY_END();
}
