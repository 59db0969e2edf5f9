/*
 * firmware/service/service.h: while a hold or a program stop stands, nothing of the program that
 * lies behind it happens until RESUME.
 */
#include "service_bench.h"

#include <stdio.h>

void setUp(void)
{
    bench_set_up();
}

void tearDown(void)
{
}

static void cycles(unsigned count)
{
    while (count-- > 0)
        cycle();
}

static void run(const char *text)
{
    load(text);
    must(REGISTER_CYCLE_START, 1);
}

/* Held for this reason, and nothing has been switched; that stays so. */
static void expect_untouched(enum panel_hold reason)
{
    wait_for(PANEL_HELD);
    for (unsigned i = 0; i < 500; i++) {
        TEST_ASSERT_EQUAL_INT(PANEL_HELD, takt_service_get_state(&service));
        TEST_ASSERT_EQUAL_INT64(reason, shown(REGISTER_HOLD_REASON));
        TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_SPINDLE_COMMANDED));
        TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_COOLANT));
        TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_DIGITAL_OUTPUTS));
        TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_TOOL));
        cycle();
    }
}

/* What follows has been done in the end. */
static void expect_end(double x_mm)
{
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(PANEL_OUTCOME_COMPLETED, shown(REGISTER_OUTCOME));
    TEST_ASSERT_EQUAL_INT64(0x18, shown(REGISTER_DIGITAL_OUTPUTS));
    TEST_ASSERT_EQUAL_INT64(3, shown(REGISTER_TOOL));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, x_mm, service.at.at[AXIS_X]);
}

#define SWITCHES "M3 S3000\nM8\nM64 P4\nM6 T3\nM62 P3\n"

/* Stands between the motions, and held so many times. */
static void expect_held_at(const char *stops, unsigned times)
{
    static char text[200];

    TEST_ASSERT_TRUE(snprintf(text, sizeof text, "G21 F3000\nG1 X1\n%s" SWITCHES "G1 X2\nM2\n",
                              stops) < (int)sizeof text);
    run(text);
    for (unsigned i = 0; i < times; i++) {
        expect_untouched(PANEL_HOLD_PROGRAM);
        must(REGISTER_RESUME, 1);
    }
    expect_end(2);
}

static void test_what_stands_behind_m0_waits_for_resume(void)
{
    expect_held_at("M0\n", 1);
}

static void test_each_m0_holds(void)
{
    expect_held_at("M0\nM0\nM0\n", 3);
}

static void test_m0_holds_in_front_of_the_first_motion_and_of_the_end(void)
{
    run("M0\nM2\n");
    expect_untouched(PANEL_HOLD_PROGRAM);
    TEST_ASSERT_EQUAL_INT64(PANEL_OUTCOME_NONE, shown(REGISTER_OUTCOME));
    must(REGISTER_RESUME, 1);
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(PANEL_OUTCOME_COMPLETED, shown(REGISTER_OUTCOME));
}

static void test_m0_does_not_move_the_axes(void)
{
    run("G21 F3000\nG1 X1\nM0\nG1 X2\nM2\n");
    wait_for(PANEL_HELD);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, service.at.at[AXIS_X]);
    cycles(500);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, service.at.at[AXIS_X]);
}

static void test_m1_stops_only_where_the_operator_wants_it(void)
{
    expect_held_at("M1\n", 0);
    start_line("G0 X0\nM5\nM9\nM65 P3\nM65 P4\nM61 Q0\n");
    wait_for(PANEL_IDLE);
    must(REGISTER_MODE, PANEL_MODE_PROGRAM);
    must(REGISTER_OPTIONAL_STOP, 1);
    expect_held_at("M1\nM1\n", 2);
}

static void test_m0_holds_where_m53_forbids_the_feed_hold(void)
{
    expect_held_at("M53 P0\nM0\n", 1);
}

static void test_an_error_behind_m0_waits_too(void)
{
    run("G21 F3000\nG1 X1\nM0\nG1 Q5\nM2\n");
    expect_untouched(PANEL_HOLD_PROGRAM);
    must(REGISTER_RESUME, 1);
    wait_for(PANEL_ALARM);
}

static void test_single_block_holds_what_stands_behind_the_last_motion(void)
{
    must(REGISTER_SINGLE_BLOCK, 1);
    run("G21 F3000\nG1 X2\n" SWITCHES "M2\n");
    expect_untouched(PANEL_HOLD_SINGLE_BLOCK);
    must(REGISTER_RESUME, 1);
    expect_end(2);
}

static void test_a_hold_in_a_dwell_pauses_it(void)
{
    run("G21 F3000\nG1 X1\nG4 P0.3\n" SWITCHES "G1 X2\nM2\n");
    while (service.at.at[AXIS_X] != 1.0)
        cycle();
    cycles(100);
    must(REGISTER_FEED_HOLD, 1);
    expect_untouched(PANEL_HOLD_OPERATOR);
    must(REGISTER_RESUME, 1);
    cycles(150);
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_COOLANT));
    cycles(100);
    TEST_ASSERT_EQUAL_INT64(2, shown(REGISTER_COOLANT));
    expect_end(2);
}

static void test_a_hold_in_the_last_dwell_keeps_the_program_from_ending(void)
{
    run("G4 P0.1\nM2\n");
    cycles(50);
    must(REGISTER_FEED_HOLD, 1);
    expect_untouched(PANEL_HOLD_OPERATOR);
    must(REGISTER_RESUME, 1);
    wait_for(PANEL_IDLE);
}

static void test_a_hold_pauses_the_wait_for_an_input(void)
{
    run("M66 P0 L3 Q0.3\n" SWITCHES "G21 F3000\nG1 X2\nM2\n");
    cycles(100);
    must(REGISTER_FEED_HOLD, 1);
    expect_untouched(PANEL_HOLD_OPERATOR);
    world.digital = 1;
    expect_untouched(PANEL_HOLD_OPERATOR);
    must(REGISTER_RESUME, 1);
    expect_end(2);
}

/* More events in a row than one cycle passes, held at each cycle once. */
static void test_of_many_events_in_a_row_none_happens_in_a_hold(void)
{
    static char text[4000];
    int length = sprintf(text, "G4 P0.02\n");

    for (unsigned i = 0; i < 150; i++)
        length += sprintf(text + length, "M6%u P1\n", 4 + i % 2);
    (void)sprintf(text + length, "M2\n");
    load(text);
    for (unsigned at = 1;; at++) {
        must(REGISTER_CYCLE_START, 1);
        cycles(at);
        if (takt_service_get_state(&service) == PANEL_IDLE)
            break;
        must(REGISTER_FEED_HOLD, 1);
        cycle();
        const uint32_t before = service.controller.path.first;
        cycles(20);
        TEST_ASSERT_EQUAL_UINT32(before, service.controller.path.first);
        must(REGISTER_RESUME, 1);
        wait_for(PANEL_IDLE);
        TEST_ASSERT_TRUE(at < 40);
    }
}

static void test_reset_in_a_hold_does_nothing_of_what_stands_behind_it(void)
{
    run("G21 F3000\nG1 X1\nM0\nM64 P4\nM2\n");
    wait_for(PANEL_HELD);
    must(REGISTER_RESET, 1);
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(PANEL_OUTCOME_ABORTED, shown(REGISTER_OUTCOME));
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_DIGITAL_OUTPUTS));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_what_stands_behind_m0_waits_for_resume);
    RUN_TEST(test_each_m0_holds);
    RUN_TEST(test_m0_holds_in_front_of_the_first_motion_and_of_the_end);
    RUN_TEST(test_m0_does_not_move_the_axes);
    RUN_TEST(test_m1_stops_only_where_the_operator_wants_it);
    RUN_TEST(test_m0_holds_where_m53_forbids_the_feed_hold);
    RUN_TEST(test_an_error_behind_m0_waits_too);
    RUN_TEST(test_single_block_holds_what_stands_behind_the_last_motion);
    RUN_TEST(test_a_hold_in_a_dwell_pauses_it);
    RUN_TEST(test_a_hold_in_the_last_dwell_keeps_the_program_from_ending);
    RUN_TEST(test_a_hold_pauses_the_wait_for_an_input);
    RUN_TEST(test_of_many_events_in_a_row_none_happens_in_a_hold);
    RUN_TEST(test_reset_in_a_hold_does_nothing_of_what_stands_behind_it);
    return UNITY_END();
}
