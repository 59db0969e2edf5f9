/*
 * firmware/service/service.h: jogs, and what ends one that goes on as long as its coil is set.
 */
#include "service_bench.h"

void setUp(void)
{
    bench_set_up();
}

void tearDown(void)
{
}

static void test_a_jog_goes_its_distance_at_its_feed(void)
{
    must(REGISTER_MODE, PANEL_MODE_JOG);
    must(REGISTER_JOG_AXIS, AXIS_Y);
    must(REGISTER_JOG_FEED, 1200);
    must(REGISTER_JOG_DISTANCE, 12500);
    must(REGISTER_JOG_MINUS, 1);
    TEST_ASSERT_EQUAL_INT64(1, shown(REGISTER_JOG_MINUS));
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_JOG_PLUS, 1));
    for (int i = 0; i < 300; i++)
        cycle();
    TEST_ASSERT_EQUAL_INT64(12000, shown(REGISTER_FEED));
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(-12500, shown(REGISTER_POSITION_Y));
}

static void test_a_jog_stays_within_the_travel(void)
{
    must(REGISTER_MODE, PANEL_MODE_JOG);
    must(REGISTER_JOG_DISTANCE, 500001);
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_VALUE, order(REGISTER_JOG_PLUS, 1));
    must(REGISTER_JOG_DISTANCE, 500000);
    must(REGISTER_JOG_FEED, 60000);
    must(REGISTER_JOG_PLUS, 1);
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(500000, shown(REGISTER_POSITION_X));
}

static void test_a_jog_without_end_is_for_a_panel_in_control(void)
{
    must(REGISTER_MODE, PANEL_MODE_JOG);
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_JOG_PLUS, 1));
    must(REGISTER_WATCHDOG, 60000);
    must(REGISTER_JOG_PLUS, 1);
    TEST_ASSERT_EQUAL_INT(PANEL_JOGGING, takt_service_get_state(&service));
}

static void begin_endless_jog(void)
{
    must(REGISTER_MODE, PANEL_MODE_JOG);
    must(REGISTER_WATCHDOG, 60000);
    must(REGISTER_JOG_PLUS, 1);
    for (int i = 0; i < 100; i++)
        cycle();
    TEST_ASSERT_EQUAL_INT(PANEL_JOGGING, takt_service_get_state(&service));
}

static void test_a_jog_without_end_ends_when_control_is_given_up(void)
{
    begin_endless_jog();
    must(REGISTER_WATCHDOG, 0);
    wait_for(PANEL_IDLE);
    TEST_ASSERT_TRUE(shown(REGISTER_POSITION_X) < 20000);
}

static void test_a_jog_ends_as_it_has_begun_whatever_is_set_meanwhile(void)
{
    begin_endless_jog();
    must(REGISTER_JOG_DISTANCE, 1000);
    must(REGISTER_JOG_PLUS, 0);
    wait_for(PANEL_IDLE);
    TEST_ASSERT_TRUE(shown(REGISTER_POSITION_X) < 20000);
    must(REGISTER_JOG_DISTANCE, 50000);
    must(REGISTER_JOG_MINUS, 1);
    must(REGISTER_JOG_DISTANCE, 0);
    must(REGISTER_JOG_MINUS, 0);
    must(REGISTER_WATCHDOG, 0);
    wait_for(PANEL_IDLE);
    TEST_ASSERT_TRUE(shown(REGISTER_POSITION_X) < -29000);
}

static void test_a_jog_and_homing_leave_the_outcome_of_the_program(void)
{
    load("G1 X1\nM2\n");
    must(REGISTER_CYCLE_START, 1);
    wait_for(PANEL_ALARM);
    must(REGISTER_RESET, 1);
    must(REGISTER_MODE, PANEL_MODE_JOG);
    must(REGISTER_JOG_DISTANCE, 1000);
    must(REGISTER_JOG_PLUS, 1);
    wait_for(PANEL_IDLE);
    must(REGISTER_HOME, 1);
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(PANEL_OUTCOME_FAILED, shown(REGISTER_OUTCOME));
    TEST_ASSERT_EQUAL_INT64(3, shown(REGISTER_RUNS));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_jog_goes_its_distance_at_its_feed);
    RUN_TEST(test_a_jog_stays_within_the_travel);
    RUN_TEST(test_a_jog_without_end_is_for_a_panel_in_control);
    RUN_TEST(test_a_jog_without_end_ends_when_control_is_given_up);
    RUN_TEST(test_a_jog_ends_as_it_has_begun_whatever_is_set_meanwhile);
    RUN_TEST(test_a_jog_and_homing_leave_the_outcome_of_the_program);
    return UNITY_END();
}
