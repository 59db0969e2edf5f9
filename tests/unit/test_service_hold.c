/*
 * firmware/service/service.h: coming to rest on the path and going on, for every cause; giving up;
 * jogs that are let go.
 */
#include "service_verifier.h"

void setUp(void)
{
    bench_set_up();
    begin_judging();
}

void tearDown(void)
{
}

/* A cut at 50 mm/s, half a second old. */
static void cut(void)
{
    load("G21 F3000\nG1 X200\nM2\n");
    must(REGISTER_CYCLE_START, 1);
    verified_cycles(500);
    TEST_ASSERT_EQUAL_INT(PANEL_RUNNING, takt_service_get_state(&service));
    TEST_ASSERT_GREATER_THAN(10, service.at.at[AXIS_X]);
}

/* At rest on the way; returns where. */
static double expect_rest(void)
{
    const double before = service.at.at[AXIS_X];

    verified_cycles(500);
    const double at = service.at.at[AXIS_X];

    verified_cycles(200);
    TEST_ASSERT_EQUAL_DOUBLE(at, service.at.at[AXIS_X]);
    TEST_ASSERT_TRUE(at > before && at < 199);
    return at;
}

static void test_a_hold_rests_on_the_path_and_resume_goes_on_to_its_end(void)
{
    cut();
    must(REGISTER_FEED_HOLD, 1);
    TEST_ASSERT_EQUAL_INT(PANEL_HELD, takt_service_get_state(&service));
    (void)expect_rest();
    TEST_ASSERT_EQUAL_INT64(PANEL_HOLD_OPERATOR, shown(REGISTER_HOLD_REASON));
    TEST_ASSERT_EQUAL_INT64(PANEL_OVERRIDE_HELD, shown(REGISTER_OVERRIDE_REASON));
    must(REGISTER_RESUME, 1);
    verified_wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(200000, shown(REGISTER_POSITION_X));
    TEST_ASSERT_EQUAL_INT64(PANEL_OUTCOME_COMPLETED, shown(REGISTER_OUTCOME));
    expect_limits_kept();
}

static void test_a_program_given_up_rests_within_the_limits_and_another_begins_there(void)
{
    cut();
    must(REGISTER_RESET, 1);
    TEST_ASSERT_EQUAL_INT(PANEL_STOPPING, takt_service_get_state(&service));
    verified_wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(PANEL_OUTCOME_ABORTED, shown(REGISTER_OUTCOME));
    TEST_ASSERT_TRUE(service.at.at[AXIS_X] < 199);
    must(REGISTER_CYCLE_START, 1);
    verified_wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(200000, shown(REGISTER_POSITION_X));
    expect_limits_kept();
}

static void test_a_program_held_can_be_given_up(void)
{
    cut();
    must(REGISTER_FEED_HOLD, 1);
    (void)expect_rest();
    must(REGISTER_RESET, 1);
    verified_wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(PANEL_OUTCOME_ABORTED, shown(REGISTER_OUTCOME));
}

static void test_a_feed_override_of_0_rests_and_of_more_goes_on(void)
{
    cut();
    must(REGISTER_FEED_OVERRIDE, 0);
    (void)expect_rest();
    TEST_ASSERT_EQUAL_INT(PANEL_RUNNING, takt_service_get_state(&service));
    must(REGISTER_FEED_OVERRIDE, 500);
    verified_cycles(500);
    TEST_ASSERT_INT64_WITHIN(1, 15000, shown(REGISTER_FEED));
    must(REGISTER_FEED_OVERRIDE, 1200);
    verified_wait_for(PANEL_IDLE);
    expect_limits_kept();
}

/*
 * The spindle's drive is lost in a cut: the axes rest within their limits, and stay until the
 * operator has seen it.
 */
static void test_a_spindle_lost_in_a_cut_rests_the_axes_until_acknowledged(void)
{
    load("G21 F3000\nM3 S6000\nG1 X200\nM2\n");
    must(REGISTER_CYCLE_START, 1);
    verified_cycles(500);
    TEST_ASSERT_EQUAL_INT64(60000, shown(REGISTER_SPINDLE_COMMANDED));
    world.spindle.silent = true;
    world.spindle.at_speed = false;
    (void)expect_rest();
    TEST_ASSERT_EQUAL_INT64(PANEL_ALARM_SPINDLE, shown(REGISTER_ALARM));
    world.spindle.silent = false;
    world.spindle.at_speed = true;
    verified_cycles(100);
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_RESUME, 1));
    must(REGISTER_ACKNOWLEDGE, 1);
    verified_cycles(100);
    TEST_ASSERT_EQUAL_INT(PANEL_HELD, takt_service_get_state(&service));
    must(REGISTER_RESUME, 1);
    verified_wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(200000, shown(REGISTER_POSITION_X));
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_SPINDLE_COMMANDED));
    expect_limits_kept();
}

static void test_a_silent_panel_in_control_rests_the_axes(void)
{
    cut();
    must(REGISTER_WATCHDOG, 200);
    (void)expect_rest();
    TEST_ASSERT_EQUAL_INT(PANEL_HELD, takt_service_get_state(&service));
    TEST_ASSERT_EQUAL_INT64(PANEL_HOLD_PANEL, shown(REGISTER_HOLD_REASON));
    expect_limits_kept();
}

static void test_a_jog_ends_when_it_is_let_go(void)
{
    must(REGISTER_MODE, PANEL_MODE_JOG);
    must(REGISTER_WATCHDOG, 60000);
    must(REGISTER_JOG_FEED, 3000);
    must(REGISTER_JOG_PLUS, 1);
    verified_cycles(500);
    TEST_ASSERT_EQUAL_INT64(1, shown(REGISTER_JOG_PLUS));
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_JOG_MINUS));
    must(REGISTER_JOG_PLUS, 0);
    TEST_ASSERT_EQUAL_INT(PANEL_STOPPING, takt_service_get_state(&service));
    verified_wait_for(PANEL_IDLE);
    TEST_ASSERT_TRUE(service.at.at[AXIS_X] > 10 && service.at.at[AXIS_X] < 60);
    TEST_ASSERT_EQUAL_INT64(1, shown(REGISTER_RUNS));
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_JOG_PLUS));
    expect_limits_kept();
}

static void expect_held_at(double place_mm, enum panel_hold reason)
{
    verified_wait_for(PANEL_HELD);
    verified_cycles(300);
    TEST_ASSERT_EQUAL_INT64(reason, shown(REGISTER_HOLD_REASON));
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, place_mm, service.at.at[AXIS_X]);
}

static void test_single_block_holds_at_the_end_of_each_motion(void)
{
    load("G21 F3000 G64\nG1 X10\nX20\nX30\nM2\n");
    must(REGISTER_SINGLE_BLOCK, 1);
    must(REGISTER_CYCLE_START, 1);
    for (int i = 1; i <= 3; i++) {
        expect_held_at(10.0 * i, PANEL_HOLD_SINGLE_BLOCK);
        TEST_ASSERT_EQUAL_DOUBLE(10.0 * i, service.at.at[AXIS_X]);
        must(REGISTER_CYCLE_START, 1);
    }
    verified_wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(PANEL_OUTCOME_COMPLETED, shown(REGISTER_OUTCOME));
}

static void test_m0_holds_and_m1_only_if_the_operator_wants_it(void)
{
    load("G21 F3000\nG1 X10\nM0\nG1 X20\nM1\nG1 X30\nM2\n");
    must(REGISTER_CYCLE_START, 1);
    expect_held_at(10, PANEL_HOLD_PROGRAM);
    must(REGISTER_CYCLE_START, 1);
    verified_wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(30000, shown(REGISTER_POSITION_X));
    start_line("G0 X0");
    verified_wait_for(PANEL_IDLE);
    must(REGISTER_MODE, PANEL_MODE_PROGRAM);
    must(REGISTER_OPTIONAL_STOP, 1);
    must(REGISTER_CYCLE_START, 1);
    expect_held_at(10, PANEL_HOLD_PROGRAM);
    must(REGISTER_RESUME, 1);
    expect_held_at(20, PANEL_HOLD_PROGRAM);
    must(REGISTER_RESUME, 1);
    verified_wait_for(PANEL_IDLE);
}

static void test_a_line_leaves_the_spindle_turning_and_a_program_does_not(void)
{
    start_line("M3 S1000");
    verified_wait_for(PANEL_IDLE);
    start_line("G0 X1");
    verified_wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(10000, shown(REGISTER_SPINDLE_COMMANDED));
    start_line("M5");
    verified_wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_SPINDLE_COMMANDED));
    load("M3 S1000\nM8\nG0 X0\nM2\n");
    must(REGISTER_MODE, PANEL_MODE_PROGRAM);
    must(REGISTER_CYCLE_START, 1);
    verified_wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_SPINDLE_COMMANDED));
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_COOLANT));
}

/* A cut that lets nobody hold it, and then one that does, to 200. */
static void cut_unheld(void)
{
    load("G21 F3000\nM3 S6000\nM53 P0\nG1 X100\nM53 P1\nG1 X200\nM2\n");
    must(REGISTER_CYCLE_START, 1);
    verified_cycles(500);
}

static void test_where_m53_forbids_the_hold_it_is_told_when_it_takes_effect(void)
{
    cut_unheld();
    must(REGISTER_FEED_HOLD, 1);
    while (service.at.at[AXIS_X] < 99) {
        TEST_ASSERT_EQUAL_INT(PANEL_RUNNING, takt_service_get_state(&service));
        TEST_ASSERT_EQUAL_INT64(PANEL_HOLD_NONE, shown(REGISTER_HOLD_REASON));
        TEST_ASSERT_EQUAL_INT64(PANEL_OVERRIDE_FOLLOWS, shown(REGISTER_OVERRIDE_REASON));
        TEST_ASSERT_EQUAL_INT64(1, shown(REGISTER_FEED_HOLD));
        verified_cycle();
    }
    (void)expect_rest();
    TEST_ASSERT_EQUAL_INT(PANEL_HELD, takt_service_get_state(&service));
    TEST_ASSERT_EQUAL_INT64(PANEL_HOLD_OPERATOR, shown(REGISTER_HOLD_REASON));
    TEST_ASSERT_TRUE(service.at.at[AXIS_X] < 110);
    expect_limits_kept();
}

static void test_reset_gives_up_what_m53_keeps_from_being_held(void)
{
    cut_unheld();
    must(REGISTER_RESET, 1);
    verified_wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(PANEL_OUTCOME_ABORTED, shown(REGISTER_OUTCOME));
    TEST_ASSERT_TRUE(service.at.at[AXIS_X] < 50);
    expect_limits_kept();
}

static void test_a_silent_panel_stops_what_m53_keeps_from_being_held(void)
{
    cut_unheld();
    must(REGISTER_WATCHDOG, 200);
    (void)expect_rest();
    TEST_ASSERT_TRUE(service.at.at[AXIS_X] < 50);
    TEST_ASSERT_EQUAL_INT64(PANEL_HOLD_PANEL, shown(REGISTER_HOLD_REASON));
    expect_limits_kept();
}

/* Also when the operator has asked for a hold before, which had no effect. */
static void test_a_lost_spindle_stops_what_m53_keeps_from_being_held(void)
{
    cut_unheld();
    must(REGISTER_FEED_HOLD, 1);
    world.spindle.silent = true;
    (void)expect_rest();
    TEST_ASSERT_TRUE(service.at.at[AXIS_X] < 50);
    TEST_ASSERT_EQUAL_INT64(PANEL_HOLD_SPINDLE, shown(REGISTER_HOLD_REASON));
    expect_limits_kept();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_hold_rests_on_the_path_and_resume_goes_on_to_its_end);
    RUN_TEST(test_a_program_given_up_rests_within_the_limits_and_another_begins_there);
    RUN_TEST(test_a_program_held_can_be_given_up);
    RUN_TEST(test_a_feed_override_of_0_rests_and_of_more_goes_on);
    RUN_TEST(test_a_spindle_lost_in_a_cut_rests_the_axes_until_acknowledged);
    RUN_TEST(test_a_silent_panel_in_control_rests_the_axes);
    RUN_TEST(test_a_jog_ends_when_it_is_let_go);
    RUN_TEST(test_single_block_holds_at_the_end_of_each_motion);
    RUN_TEST(test_m0_holds_and_m1_only_if_the_operator_wants_it);
    RUN_TEST(test_a_line_leaves_the_spindle_turning_and_a_program_does_not);
    RUN_TEST(test_where_m53_forbids_the_hold_it_is_told_when_it_takes_effect);
    RUN_TEST(test_reset_gives_up_what_m53_keeps_from_being_held);
    RUN_TEST(test_a_silent_panel_stops_what_m53_keeps_from_being_held);
    RUN_TEST(test_a_lost_spindle_stops_what_m53_keeps_from_being_held);
    return UNITY_END();
}
