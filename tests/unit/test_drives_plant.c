#include "drives/drive_plant.h"
#include "unity.h"

#include <math.h>

#define CYCLE_NS 1000000u
#define CYCLE_S  1e-3

static struct drive_plant_config config;
static struct drive_plant plant;
static struct servo_loop loop;

/* The loops of a drive's firmware, on the plant. */
static void start(void)
{
    const struct motor_port motor = drive_plant_get_port(&plant);
    const struct servo_loop_config tuned = drive_plant_get_loop(&config);

    drive_plant_init(&plant, &config, false);
    takt_servo_loop_init(&loop, &tuned, &motor);
}

void setUp(void)
{
    drive_plant_set_default(&config);
    TEST_ASSERT_NULL(drive_plant_check(&config));
    start();
}

void tearDown(void)
{
}

static void follow_for(unsigned cycles, double velocity_mm_s)
{
    for (unsigned i = 0; i < cycles; i++)
        takt_servo_loop_follow(&loop, loop.command_mm + velocity_mm_s * CYCLE_S, CYCLE_NS);
}

static void test_a_plant_at_rest_stays_exactly_where_it_is(void)
{
    follow_for(1000, 0);
    TEST_ASSERT_TRUE(plant.position_mm == 0);
    TEST_ASSERT_TRUE(plant.velocity_mm_s == 0);
    TEST_ASSERT_TRUE(takt_servo_loop_following_error_mm(&loop) == 0);
}

/*
 * Speed up by 1000 mm/s2, then 100 mm/s: the largest error of the ramp, and that of the last tenth
 * of a second.
 */
static void measure_ramp(double *ramp_mm, double *constant_mm)
{
    *ramp_mm = *constant_mm = 0;
    for (unsigned k = 1; k <= 1000; k++) {
        follow_for(1, k < 100 ? k : 100);
        double error_mm = fabs(takt_servo_loop_following_error_mm(&loop));
        *ramp_mm = fmax(*ramp_mm, error_mm);
        if (k > 900)
            *constant_mm = fmax(*constant_mm, error_mm);
    }
}

static void test_following_error_is_micrometres_at_constant_velocity_and_below_50_in_ramps(void)
{
    double ramp_mm, constant_mm;
    measure_ramp(&ramp_mm, &constant_mm);
    TEST_ASSERT_TRUE(constant_mm < 0.005);
    TEST_ASSERT_TRUE(ramp_mm < 0.05);
    TEST_ASSERT_TRUE(ramp_mm > 0.001);
}

/* Without feed-forward a position loop lags by velocity / Kv. */
static void test_without_feed_forward_the_lag_is_velocity_by_gain(void)
{
    double ramp_mm, constant_mm;
    config.velocity_feed_forward_ratio = 0;
    start();
    measure_ramp(&ramp_mm, &constant_mm);
    TEST_ASSERT_TRUE(fabs(constant_mm - 100 / config.position_gain_per_s) < 0.001);
}

/* Against friction a proportional velocity loop alone needs an error:  Kp Kv e = (b / J) v. */
static void test_without_integral_part_friction_leaves_the_error_of_its_formula(void)
{
    double ramp_mm, constant_mm;
    config.velocity_integral_time_s = 0;
    start();
    measure_ramp(&ramp_mm, &constant_mm);
    double friction_mm_s2 = 100 * config.viscous_friction_nm_s_per_rad / config.inertia_kg_m2;
    double expected_mm = friction_mm_s2 / (6.283185307179586 * config.velocity_bandwidth_hz) /
                         config.position_gain_per_s;
    TEST_ASSERT_TRUE(fabs(constant_mm - expected_mm) < 0.01 * expected_mm);
}

/* Angular acceleration is torque by inertia; a turn is one lead. */
static void test_the_torque_limit_bounds_the_acceleration(void)
{
    double limit_mm_s2 = config.torque_max_nm / config.inertia_kg_m2 *
                         config.travel_per_revolution_mm / 6.283185307179586;
    takt_servo_loop_follow(&loop, 10, CYCLE_NS);
    double reached_mm_s2 = plant.velocity_mm_s / CYCLE_S;
    TEST_ASSERT_TRUE(reached_mm_s2 <= limit_mm_s2 * (1 + 1e-12));
    TEST_ASSERT_TRUE(reached_mm_s2 > 0.99 * limit_mm_s2);
}

static void test_a_step_settles_at_its_end_and_does_not_overshoot_much(void)
{
    double highest_mm = 0;
    takt_servo_loop_follow(&loop, 0.1, CYCLE_NS);
    for (unsigned i = 0; i < 1000; i++) {
        follow_for(1, 0);
        highest_mm = fmax(highest_mm, plant.position_mm);
    }
    TEST_ASSERT_TRUE(fabs(plant.position_mm - 0.1) < 1e-4);
    TEST_ASSERT_TRUE(highest_mm < 0.15);
}

static void test_the_encoder_reports_whole_steps_of_its_own(void)
{
    config.encoder_counts_per_revolution = 1000;
    config.start_mm = 0.1234;
    start();
    for (unsigned i = 0; i < 500; i++) {
        follow_for(1, 37.7);
        double steps = loop.measured_mm / 0.01;
        TEST_ASSERT_TRUE(fabs(steps - round(steps)) < 1e-6);
        TEST_ASSERT_TRUE(fabs(loop.measured_mm - plant.position_mm) <= 0.005 + 1e-9);
    }
}

static void test_without_encoder_steps_the_position_itself_is_measured(void)
{
    config.encoder_counts_per_revolution = 0;
    config.start_mm = 0.123456789;
    start();
    follow_for(100, 12.3);
    TEST_ASSERT_TRUE(loop.measured_mm == plant.position_mm);
}

static void test_braking_stops_with_the_quick_stop_deceleration_and_then_stands(void)
{
    unsigned cycles = 0;
    follow_for(500, 100);
    double from_mm = plant.position_mm;
    takt_servo_loop_begin_brake(&loop, config.quick_stop_deceleration_mm_s2);
    while (!takt_servo_loop_brake(&loop, CYCLE_NS))
        TEST_ASSERT_TRUE(++cycles < 200);
    double way_mm = plant.position_mm - from_mm;
    double expected_mm = 100.0 * 100.0 / 2 / config.quick_stop_deceleration_mm_s2;
    TEST_ASSERT_TRUE(fabs(way_mm - expected_mm) < 0.01);
    TEST_ASSERT_TRUE(cycles >= 49);
    TEST_ASSERT_TRUE(fabs(plant.velocity_mm_s) < 0.02);
}

/*
 * At the end of a stop the motor overshoots and turns round. In the cycle in which it does, way out
 * and way back may cancel, although it moves. What the encoder cannot tell from standstill is less
 * than two steps in a loop period.
 */
static void test_a_motor_that_is_said_to_stand_does_not_run_on_without_torque(void)
{
    double unseen_mm_s = 2 * loop.encoder_step_mm / (config.loop_period_us * 1e-6);
    for (unsigned i = 1; i <= 2000; i++) {
        start();
        follow_for(200, 0.05 * i);
        takt_servo_loop_begin_brake(&loop, config.quick_stop_deceleration_mm_s2);
        for (unsigned cycles = 0; !takt_servo_loop_brake(&loop, CYCLE_NS); cycles++)
            TEST_ASSERT_TRUE(cycles < 250);
        TEST_ASSERT_TRUE(fabs(plant.velocity_mm_s) < unseen_mm_s);
    }
}

static void test_braking_begins_at_the_motor_however_far_the_command_was(void)
{
    unsigned cycles = 0;
    takt_servo_loop_follow(&loop, 1000, CYCLE_NS);
    takt_servo_loop_begin_brake(&loop, config.quick_stop_deceleration_mm_s2);
    TEST_ASSERT_TRUE(takt_servo_loop_following_error_mm(&loop) == 0);
    while (!takt_servo_loop_brake(&loop, CYCLE_NS))
        TEST_ASSERT_TRUE(++cycles < 200);
    TEST_ASSERT_TRUE(plant.position_mm < 0.5);
}

static void test_without_torque_friction_stops_the_motor_and_the_command_stays_with_it(void)
{
    follow_for(500, 100);
    double from_mm = plant.position_mm, velocity_mm_s = plant.velocity_mm_s;
    for (unsigned i = 0; i < 10000; i++) {
        takt_servo_loop_coast(&loop, CYCLE_NS);
        TEST_ASSERT_TRUE(takt_servo_loop_following_error_mm(&loop) == 0);
    }
    /* v dx = -v J / b dv: it runs out over v J / b */
    double way_mm = velocity_mm_s * config.inertia_kg_m2 / config.viscous_friction_nm_s_per_rad;
    TEST_ASSERT_TRUE(plant.velocity_mm_s == 0);
    TEST_ASSERT_TRUE(fabs(plant.position_mm - from_mm - way_mm) < 0.01 * way_mm);
}

/* A long cycle has more steps of the same length, so the motor stays as stable as in short ones. */
static void test_any_cycle_from_100_us_to_10_ms_follows(void)
{
    static const uint32_t cycles_ns[] = {100000, 250000, 333000, 1000000, 2000000, 10000000};
    for (unsigned i = 0; i < sizeof cycles_ns / sizeof cycles_ns[0]; i++) {
        start();
        for (uint32_t time_ns = 0; time_ns < 1000000000; time_ns += cycles_ns[i]) {
            double command_mm = 5 * (1 - cos(6e-9 * time_ns));
            takt_servo_loop_follow(&loop, command_mm, cycles_ns[i]);
            TEST_ASSERT_TRUE(fabs(takt_servo_loop_following_error_mm(&loop)) < 0.05);
        }
    }
}

/* Its torque stands against c: the position loop alone holds c J / h short of the command. */
static void test_dry_friction_holds_the_motor_until_the_torque_exceeds_it(void)
{
    config.coulomb_friction_nm = 0.5;
    config.velocity_integral_time_s = 0;
    config.velocity_feed_forward_ratio = 0;
    start();
    double held_mm_s2 = 0.01 / 6.283185307179586 * 1000 * 0.5 / 3e-4;
    double gain_mm_s2 = 6.283185307179586 * 100 * 100; /* Kp Kv, per mm */
    double held_mm = held_mm_s2 / gain_mm_s2;
    takt_servo_loop_follow(&loop, 0.9 * held_mm, CYCLE_NS);
    for (unsigned i = 0; i < 100; i++)
        takt_servo_loop_follow(&loop, 0.9 * held_mm, CYCLE_NS);
    TEST_ASSERT_TRUE(fabs(plant.position_mm) < 0.05 * held_mm);
    for (unsigned i = 0; i < 1000; i++)
        takt_servo_loop_follow(&loop, 10 * held_mm, CYCLE_NS);
    TEST_ASSERT_TRUE(plant.position_mm > 8 * held_mm && plant.position_mm < 10 * held_mm);
    TEST_ASSERT_TRUE(plant.velocity_mm_s == 0);
}

static void test_without_power_dry_friction_stops_the_motor_in_the_time_of_its_torque(void)
{
    config.coulomb_friction_nm = 0.5;
    config.viscous_friction_nm_s_per_rad = 0;
    start();
    follow_for(500, 50);
    double from_mm = plant.position_mm, velocity_mm_s = plant.velocity_mm_s;
    while (plant.velocity_mm_s != 0)
        takt_servo_loop_coast(&loop, CYCLE_NS);
    double held_mm_s2 = 0.01 / 6.283185307179586 * 1000 * 0.5 / 3e-4;
    double way_mm = velocity_mm_s * velocity_mm_s / (2 * held_mm_s2);
    TEST_ASSERT_TRUE(fabs(plant.position_mm - from_mm - way_mm) < 0.02 * way_mm);
}

static void test_torque_feed_forward_takes_the_error_out_of_ramps(void)
{
    double without_mm, with_mm, constant_mm;
    measure_ramp(&without_mm, &constant_mm);
    config.torque_feed_forward_ratio = 1;
    start();
    measure_ramp(&with_mm, &constant_mm);
    TEST_ASSERT_TRUE(with_mm < 0.5 * without_mm);
}

static void test_the_table_hangs_behind_by_half_the_play_on_either_side(void)
{
    config.backlash_mm = 0.04;
    start();
    follow_for(200, 10);
    TEST_ASSERT_TRUE(fabs(plant.position_mm - drive_plant_table_mm(&plant) - 0.02) < 1e-12);
    double turned_mm = drive_plant_table_mm(&plant);
    while (plant.position_mm - turned_mm > -0.015)
        follow_for(1, -1);
    TEST_ASSERT_TRUE(fabs(drive_plant_table_mm(&plant) - turned_mm) < 0.01);
    follow_for(200, -10);
    TEST_ASSERT_TRUE(fabs(plant.position_mm - drive_plant_table_mm(&plant) + 0.02) < 1e-12);
}

static void test_the_screw_has_its_error_of_pitch_and_the_encoder_does_not_see_it(void)
{
    config.pitch_error_mm = 0.01;
    config.pitch_error_period_mm = 20;
    config.start_mm = 5;
    start();
    TEST_ASSERT_TRUE(fabs(loop.measured_mm - 5) < 1e-5);
    TEST_ASSERT_TRUE(fabs(drive_plant_table_mm(&plant) - 5.01) < 1e-9);
}

static void test_an_encoder_that_is_not_absolute_counts_from_0(void)
{
    config.start_mm = 123.4;
    config.absolute_encoder = 0;
    start();
    TEST_ASSERT_TRUE(fabs(loop.measured_mm) < 1e-5);
    TEST_ASSERT_TRUE(drive_plant_table_mm(&plant) == 123.4);
    follow_for(1000, 10);
    TEST_ASSERT_TRUE(fabs(drive_plant_table_mm(&plant) - 133.4) < 0.01);
}

/* T = ambient + rise (M / M_rated)^2 (1 - exp(-t / time)) */
static void test_the_motor_warms_up_as_its_torque_says(void)
{
    config.temperature_time_s = 2;
    start();
    plant.damage.is_jammed = true;
    for (unsigned i = 0; i < 2000; i++)
        takt_servo_loop_follow(&loop, 1, CYCLE_NS);
    double ratio = takt_servo_loop_torque_ratio(&loop);
    double expected_c = 25 + 60 * ratio * ratio * (1 - exp(-1));
    TEST_ASSERT_TRUE(fabs(ratio - 3.8 / 1.27) < 1e-9);
    TEST_ASSERT_TRUE(fabs(plant.temperature_c - expected_c) < 0.01 * expected_c);
}

static void assert_wrong(const char *field)
{
    const char *found = drive_plant_check(&config);
    TEST_ASSERT_NOT_NULL(found);
    TEST_ASSERT_EQUAL_STRING(field, found);
    drive_plant_set_default(&config);
}

static void test_a_field_out_of_range_is_named(void)
{
    config.travel_per_revolution_mm = 0;
    assert_wrong("travel_per_revolution_mm");
    config.inertia_kg_m2 = -1;
    assert_wrong("inertia_kg_m2");
    config.torque_max_nm = (double)INFINITY;
    assert_wrong("torque_max_nm");
    config.velocity_feed_forward_ratio = 1.01;
    assert_wrong("velocity_feed_forward_ratio");
    config.position_gain_per_s = (double)NAN;
    assert_wrong("position_gain_per_s");
    config.loop_period_us = 0;
    assert_wrong("loop_period_us");
    config.velocity_bandwidth_hz = 1000;
    assert_wrong("loop_period_us");
    config.quick_stop_deceleration_mm_s2 = 0;
    assert_wrong("quick_stop_deceleration_mm_s2");
    config.coulomb_friction_nm = -1e-9;
    assert_wrong("coulomb_friction_nm");
    config.torque_rated_nm = 0;
    assert_wrong("torque_rated_nm");
    config.torque_feed_forward_ratio = -0.1;
    assert_wrong("torque_feed_forward_ratio");
    config.temperature_time_s = 0;
    assert_wrong("temperature_time_s");
    config.pitch_error_period_mm = 0;
    assert_wrong("pitch_error_period_mm");
    config.backlash_mm = (double)NAN;
    assert_wrong("backlash_mm");
    config.start_mm = (double)INFINITY;
    assert_wrong("start_mm");
    config.limit_switch_max_mm = config.limit_switch_min_mm;
    assert_wrong("limit_switch_max_mm");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_plant_at_rest_stays_exactly_where_it_is);
    RUN_TEST(test_following_error_is_micrometres_at_constant_velocity_and_below_50_in_ramps);
    RUN_TEST(test_without_feed_forward_the_lag_is_velocity_by_gain);
    RUN_TEST(test_without_integral_part_friction_leaves_the_error_of_its_formula);
    RUN_TEST(test_the_torque_limit_bounds_the_acceleration);
    RUN_TEST(test_a_step_settles_at_its_end_and_does_not_overshoot_much);
    RUN_TEST(test_the_encoder_reports_whole_steps_of_its_own);
    RUN_TEST(test_without_encoder_steps_the_position_itself_is_measured);
    RUN_TEST(test_braking_stops_with_the_quick_stop_deceleration_and_then_stands);
    RUN_TEST(test_a_motor_that_is_said_to_stand_does_not_run_on_without_torque);
    RUN_TEST(test_braking_begins_at_the_motor_however_far_the_command_was);
    RUN_TEST(test_without_torque_friction_stops_the_motor_and_the_command_stays_with_it);
    RUN_TEST(test_any_cycle_from_100_us_to_10_ms_follows);
    RUN_TEST(test_dry_friction_holds_the_motor_until_the_torque_exceeds_it);
    RUN_TEST(test_without_power_dry_friction_stops_the_motor_in_the_time_of_its_torque);
    RUN_TEST(test_torque_feed_forward_takes_the_error_out_of_ramps);
    RUN_TEST(test_the_table_hangs_behind_by_half_the_play_on_either_side);
    RUN_TEST(test_the_screw_has_its_error_of_pitch_and_the_encoder_does_not_see_it);
    RUN_TEST(test_an_encoder_that_is_not_absolute_counts_from_0);
    RUN_TEST(test_the_motor_warms_up_as_its_torque_says);
    RUN_TEST(test_a_field_out_of_range_is_named);
    return UNITY_END();
}
