/*
 * firmware/service/service.h: the coil SPINDLE_STOP. The spindle stands only while the axes rest in
 * a hold, and is at speed again before they go on.
 */
#include "service_bench.h"

#define CUT "G21\nM3 S6000\nG1 X100 F3000\nM2\n"

/* What is known of the spindle is as old as this. */
#define FEEDBACK_CYCLES 3

void setUp(void)
{
    bench_set_up();
}

void tearDown(void)
{
}

static double commanded(void)
{
    return takt_service_get_outputs(&service).spindle_speed_rpm;
}

/* The spindle never stands under an axis that moves. */
static void turning_cycle(void)
{
    const double before = service.at.at[AXIS_X];

    cycle();
    TEST_ASSERT_TRUE(service.at.at[AXIS_X] == before || commanded() != 0.0);
}

static void turning_cycles(unsigned count)
{
    while (count-- > 0)
        turning_cycle();
}

static void cut(const char *text)
{
    load(text);
    must(REGISTER_CYCLE_START, 1);
    for (unsigned i = 0; i < 500; i++)
        cycle();
    TEST_ASSERT_TRUE(commanded() != 0.0);
    TEST_ASSERT_TRUE(service.controller.record.feed_mm_s > 1);
}

static void test_with_the_hold_it_is_obeyed_when_the_axes_rest(void)
{
    cut(CUT);
    must(REGISTER_FEED_HOLD, 1);
    must(REGISTER_SPINDLE_STOP, 1);
    TEST_ASSERT_EQUAL_INT64(1, shown(REGISTER_SPINDLE_STOP));
    turning_cycles(500);
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_SPINDLE_COMMANDED));
    TEST_ASSERT_EQUAL_INT(PANEL_HELD, takt_service_get_state(&service));
}

static void test_without_a_hold_it_is_refused(void)
{
    cut(CUT);
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_SPINDLE_STOP, 1));
}

/* Also where the program goes on with motions that it lets nobody hold. */
static void test_the_spindle_turns_as_long_as_the_program_forbids_the_hold(void)
{
    cut("G21\nM3 S6000\nM53 P0\nG1 X30 F3000\nG1 X60 F600\nM53 P1\nG1 X100\nM2\n");
    must(REGISTER_FEED_HOLD, 1);
    must(REGISTER_SPINDLE_STOP, 1);
    TEST_ASSERT_EQUAL_INT(PANEL_RUNNING, takt_service_get_state(&service));
    while (takt_service_get_state(&service) == PANEL_RUNNING)
        turning_cycle();
    turning_cycles(500);
    TEST_ASSERT_EQUAL_INT(PANEL_HELD, takt_service_get_state(&service));
    TEST_ASSERT_TRUE(service.at.at[AXIS_X] > 59.9 && service.at.at[AXIS_X] < 61);
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_SPINDLE_COMMANDED));
}

/* In a dwell the axes stand: what comes behind it waits, whatever it would forbid. */
static void test_at_rest_nothing_behind_takes_the_hold_back(void)
{
    cut("G21 G61\nM3 S6000\nG1 X25 F3000\nM53 P0\nG4 P0.5\nG1 X60\nM2\n");
    while (service.at.at[AXIS_X] != 25.0)
        cycle();
    must(REGISTER_FEED_HOLD, 1);
    must(REGISTER_SPINDLE_STOP, 1);
    turning_cycles(2000);
    TEST_ASSERT_EQUAL_INT(PANEL_HELD, takt_service_get_state(&service));
    TEST_ASSERT_EQUAL_DOUBLE(25.0, service.at.at[AXIS_X]);
    TEST_ASSERT_TRUE(commanded() == 0.0);
}

static void stop_at_rest(void)
{
    cut(CUT);
    must(REGISTER_FEED_HOLD, 1);
    must(REGISTER_SPINDLE_STOP, 1);
    turning_cycles(500);
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_RESUME, 1));
    must(REGISTER_SPINDLE_STOP, 0);
    TEST_ASSERT_TRUE(commanded() != 0.0);
}

static void test_the_spindle_is_at_speed_again_before_resume(void)
{
    stop_at_rest();
    for (unsigned i = 0; i < FEEDBACK_CYCLES; i++) { /* it still tells of the standstill */
        TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_RESUME, 1));
        cycle();
    }
    world.spindle.at_speed = false;
    for (unsigned i = 0; i < 300; i++) {
        cycle();
        TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_RESUME, 1));
        TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_CYCLE_START, 1));
    }
    world.spindle.at_speed = true;
    cycle();
    must(REGISTER_RESUME, 1);
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(PANEL_OUTCOME_COMPLETED, shown(REGISTER_OUTCOME));
}

/* A board without such a signal, as far as has ever been seen. */
static void test_a_spindle_that_never_tells_its_speed_is_not_waited_for(void)
{
    bench_set_up_machine();
    world.spindle.at_speed = false;
    bench_start();
    stop_at_rest();
    for (unsigned i = 0; i < 10; i++)
        cycle();
    must(REGISTER_RESUME, 1);
    wait_for(PANEL_IDLE);
}

/* It is lost, and then the panel too: another reason, the same spindle. */
static void test_a_lost_spindle_is_back_before_resume_whatever_else_holds(void)
{
    cut(CUT);
    world.spindle.silent = true;
    world.spindle.at_speed = false;
    cycle();
    must(REGISTER_WATCHDOG, 100);
    for (unsigned i = 0; i < 500; i++)
        cycle();
    TEST_ASSERT_EQUAL_INT64(PANEL_HOLD_PANEL, shown(REGISTER_HOLD_REASON));
    world.spindle.silent = false;
    cycle();
    must(REGISTER_ACKNOWLEDGE, 1);
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_RESUME, 1));
    world.spindle.at_speed = true;
    for (unsigned i = 0; i < 10; i++)
        cycle();
    must(REGISTER_RESUME, 1);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_with_the_hold_it_is_obeyed_when_the_axes_rest);
    RUN_TEST(test_without_a_hold_it_is_refused);
    RUN_TEST(test_the_spindle_turns_as_long_as_the_program_forbids_the_hold);
    RUN_TEST(test_at_rest_nothing_behind_takes_the_hold_back);
    RUN_TEST(test_the_spindle_is_at_speed_again_before_resume);
    RUN_TEST(test_a_spindle_that_never_tells_its_speed_is_not_waited_for);
    RUN_TEST(test_a_lost_spindle_is_back_before_resume_whatever_else_holds);
    return UNITY_END();
}
