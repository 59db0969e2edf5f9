/*
 * The ordered end of a service: on the path or at once, and what the drives are left in.
 */
#include "service_verifier.h"

#include "drives/virtual_drives.h"
#include "simulation/ending.h"

#define WINDING "G21 G90 G64 P0.05 F6000\nM3 S1000\nM8\nG1 X100 Y30\nG1 X200 Y0\nG1 X300 Y50\nM2\n"

/* The way to rest may take so long, and the brakes: controller_drives.c. */
#define END_CYCLES_MAX 5000U

static struct ending ending;

void setUp(void)
{
    bench_set_up();
    ending = (struct ending){0};
    begin_judging();
}

void tearDown(void)
{
}

static void run_into_motion(void)
{
    load(WINDING);
    must(REGISTER_CYCLE_START, 1);
    verified_cycles(1000);
    TEST_ASSERT_EQUAL_INT(PANEL_RUNNING, takt_service_get_state(&service));
}

static unsigned end(enum ending_way way)
{
    unsigned cycles = 0;

    ending_ask(&ending, &service.controller, way);
    while (!ending_is_over(&ending, &service.controller) && cycles < END_CYCLES_MAX) {
        verified_cycle();
        cycles++;
    }
    TEST_ASSERT_TRUE(cycles < END_CYCLES_MAX);
    return cycles;
}

static void expect_drives(enum cia402_state state)
{
    for (unsigned i = 0; i < BENCH_DRIVES; i++)
        TEST_ASSERT_EQUAL_INT(state, virtual_drive_get_state(&drives.drive[i]));
}

static double y_of_the_path_mm(double x_mm)
{
    return x_mm <= 100 ? 0.3 * x_mm : 30 - 0.3 * (x_mm - 100);
}

static void test_an_end_in_motion_rests_on_the_path_within_the_limits(void)
{
    run_into_motion();
    const unsigned cycles = end(ENDING_ON_PATH);
    const struct point *at = &service.controller.record.set;
    expect_limits_kept();
    TEST_ASSERT_TRUE(cycles > 100); /* 100 mm/s at 1000 mm/s2 */
    TEST_ASSERT_TRUE(maths_abs(at->at[AXIS_Y] - y_of_the_path_mm(at->at[AXIS_X])) <= 0.05);
    expect_drives(CIA402_SWITCH_ON_DISABLED);
    for (unsigned i = 0; i < 2; i++)
        TEST_ASSERT_TRUE(maths_abs(virtual_drive_get_position_mm(&drives.drive[i]) - at->at[i]) <
                         0.01);
}

static void test_spindle_and_coolant_are_off_at_the_end(void)
{
    run_into_motion();
    TEST_ASSERT_TRUE(takt_service_get_outputs(&service).spindle_speed_rpm == 1000);
    TEST_ASSERT_TRUE(takt_service_get_outputs(&service).flood);
    (void)end(ENDING_ON_PATH);
    TEST_ASSERT_TRUE(takt_service_get_outputs(&service).spindle_speed_rpm == 0);
    TEST_ASSERT_FALSE(takt_service_get_outputs(&service).flood);
}

/* A spindle that stops under a moving tool breaks it. */
static void test_the_spindle_turns_as_long_as_the_axes_are_on_the_path(void)
{
    run_into_motion();
    ending_ask(&ending, &service.controller, ENDING_ON_PATH);
    while (drives_get_state(&service.controller.drives) <= DRIVES_STOPPING) {
        TEST_ASSERT_TRUE(takt_service_get_outputs(&service).spindle_speed_rpm == 1000);
        (void)ending_is_over(&ending, &service.controller);
        verified_cycle();
    }
}

static void test_asked_twice_the_drives_brake_at_once(void)
{
    run_into_motion();
    ending_ask(&ending, &service.controller, ENDING_ON_PATH);
    verified_cycles(5);
    TEST_ASSERT_EQUAL_INT(DRIVES_STOPPING, drives_get_state(&service.controller.drives));
    const double from_mm = virtual_drive_get_position_mm(&drives.drive[0]);
    (void)end(ENDING_AT_ONCE);
    TEST_ASSERT_TRUE(virtual_drive_get_position_mm(&drives.drive[0]) - from_mm <
                     3.0); /* v2/2a is 2.5 */
    expect_drives(CIA402_SWITCH_ON_DISABLED);
}

static void test_on_the_way_to_the_end_an_emergency_stop_is_obeyed(void)
{
    run_into_motion();
    ending_ask(&ending, &service.controller, ENDING_ON_PATH);
    verified_cycles(5);
    TEST_ASSERT_EQUAL_INT(PANEL_STOPPING, takt_service_get_state(&service));
    must(REGISTER_FEED_HOLD, 1);
    verified_cycles(5);
    TEST_ASSERT_EQUAL_INT(PANEL_STOPPING, takt_service_get_state(&service));
    const double from_mm = virtual_drive_get_position_mm(&drives.drive[0]);
    must(REGISTER_EMERGENCY_STOP, 1);
    TEST_ASSERT_EQUAL_INT(PANEL_EMERGENCY, takt_service_get_state(&service));
    (void)end(ENDING_ON_PATH);
    TEST_ASSERT_TRUE(virtual_drive_get_position_mm(&drives.drive[0]) - from_mm <
                     3.0); /* v2/2a is 2.5 */
    TEST_ASSERT_EQUAL_INT64(PANEL_ALARM_EMERGENCY, shown(REGISTER_ALARM));
    expect_drives(CIA402_SWITCH_ON_DISABLED);
}

static void test_at_rest_the_end_takes_a_few_cycles(void)
{
    TEST_ASSERT_TRUE(end(ENDING_ON_PATH) < 50);
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_ENDED, service.alarm_text.code);
    expect_drives(CIA402_SWITCH_ON_DISABLED);
}

static void test_drives_are_left_switched_on_where_the_machine_file_says_so(void)
{
    run_into_motion();
    ending.stays_on = true;
    (void)end(ENDING_ON_PATH);
    expect_drives(CIA402_SWITCHED_ON);
    expect_limits_kept();
}

static void test_drives_that_are_being_started_are_left_off(void)
{
    bench_set_up_machine();
    bench_start();
    must(REGISTER_RESET, 1);
    (void)end(ENDING_ON_PATH);
    expect_drives(CIA402_SWITCH_ON_DISABLED);
}

static void test_an_end_after_an_alarm_of_the_program_switches_the_drives_off(void)
{
    load("G21 F600\nG1 X1\nG1 Q5\nM2\n");
    must(REGISTER_CYCLE_START, 1);
    verified_wait_for(PANEL_ALARM);
    expect_drives(CIA402_ENABLED);
    (void)end(ENDING_ON_PATH);
    expect_drives(CIA402_SWITCH_ON_DISABLED);
}

static void test_a_program_that_is_cut_short_tells_its_line(void)
{
    run_into_motion();
    TEST_ASSERT_EQUAL_UINT32(shown(REGISTER_ACTIVE_LINE), takt_service_get_cut_line(&service));
    (void)end(ENDING_ON_PATH);
    TEST_ASSERT_TRUE(takt_service_get_cut_line(&service) == 4 ||
                     takt_service_get_cut_line(&service) == 5);
}

static void test_a_program_that_comes_to_its_end_has_no_such_line(void)
{
    load("G21 F600\nG1 X1\nM2\n");
    must(REGISTER_CYCLE_START, 1);
    verified_wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_UINT32(0, takt_service_get_cut_line(&service));
}

static void test_a_lost_bus_is_an_alarm_and_a_reset_enables_the_drives_again(void)
{
    run_into_motion();
    takt_service_lose_bus(&service, 1);
    TEST_ASSERT_EQUAL_INT(PANEL_ALARM, takt_service_get_state(&service));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_BUS_LOST, service.alarm_text.code);
    TEST_ASSERT_EQUAL_STRING("the bus can1 is gone", alarm_text());
    for (unsigned i = 0; i < END_CYCLES_MAX && order(REGISTER_RESET, 1) != PANEL_DONE; i++)
        cycle();
    wait_for(PANEL_IDLE);
    expect_drives(CIA402_ENABLED);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_an_end_in_motion_rests_on_the_path_within_the_limits);
    RUN_TEST(test_spindle_and_coolant_are_off_at_the_end);
    RUN_TEST(test_the_spindle_turns_as_long_as_the_axes_are_on_the_path);
    RUN_TEST(test_asked_twice_the_drives_brake_at_once);
    RUN_TEST(test_on_the_way_to_the_end_an_emergency_stop_is_obeyed);
    RUN_TEST(test_at_rest_the_end_takes_a_few_cycles);
    RUN_TEST(test_drives_are_left_switched_on_where_the_machine_file_says_so);
    RUN_TEST(test_drives_that_are_being_started_are_left_off);
    RUN_TEST(test_an_end_after_an_alarm_of_the_program_switches_the_drives_off);
    RUN_TEST(test_a_program_that_is_cut_short_tells_its_line);
    RUN_TEST(test_a_program_that_comes_to_its_end_has_no_such_line);
    RUN_TEST(test_a_lost_bus_is_an_alarm_and_a_reset_enables_the_drives_again);
    return UNITY_END();
}
