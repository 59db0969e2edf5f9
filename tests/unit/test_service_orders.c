/*
 * firmware/service/service.h: programs, lines, homing, faults and settings, as a panel orders
 * them.
 */
#include "service_bench.h"

void setUp(void)
{
    bench_set_up();
}

void tearDown(void)
{
}

static void test_a_program_is_taken_started_and_run_to_its_end(void)
{
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_CYCLE_START, 1));
    load("G21 G90 F6000\nG1 X10 Y-5\nM2\n");
    TEST_ASSERT_EQUAL_INT64(28, shown(REGISTER_PROGRAM_SIZE));
    must(REGISTER_CYCLE_START, 1);
    TEST_ASSERT_EQUAL_INT(PANEL_RUNNING, takt_service_get_state(&service));
    TEST_ASSERT_EQUAL_INT64(1, shown(REGISTER_CYCLE_START));
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(PANEL_OUTCOME_COMPLETED, shown(REGISTER_OUTCOME));
    TEST_ASSERT_EQUAL_INT64(1, shown(REGISTER_RUNS));
    TEST_ASSERT_EQUAL_INT64(10000, shown(REGISTER_POSITION_X));
    TEST_ASSERT_EQUAL_INT64(-5000, shown(REGISTER_POSITION_Y));
    TEST_ASSERT_INT64_WITHIN(20, 10000, shown(REGISTER_ACTUAL_X));
}

static uint64_t digest(void)
{
    return (uint64_t)shown(REGISTER_DIGEST_HIGH) << 32 | (uint64_t)shown(REGISTER_DIGEST_LOW);
}

static void run_program(void)
{
    must(REGISTER_CYCLE_START, 1);
    wait_for(PANEL_IDLE);
}

static void test_the_same_program_from_the_same_place_has_the_same_digest(void)
{
    uint64_t first;

    load("G21 G90 F6000\nG1 X10\nG1 X0\nM2\n");
    run_program();
    first = digest();
    run_program();
    TEST_ASSERT_EQUAL_HEX64(first, digest());
    load("G21 G90 F6000\nG1 X11\nG1 X0\nM2\n");
    run_program();
    TEST_ASSERT_TRUE(first != digest());
}

static void test_a_program_begins_where_the_axes_stand(void)
{
    load("G21 G91 F6000\nG1 X5\nM2\n");
    run_program();
    run_program();
    TEST_ASSERT_EQUAL_INT64(10000, shown(REGISTER_POSITION_X));
    TEST_ASSERT_EQUAL_INT64(PANEL_ALARM_NONE, shown(REGISTER_ALARM));
}

static void test_an_error_ends_the_program_after_what_stands_before_it(void)
{
    load("G21 F6000\nG1 X4\nG1 X9999\nM2\n");
    must(REGISTER_CYCLE_START, 1);
    wait_for(PANEL_ALARM);
    TEST_ASSERT_EQUAL_INT64(4000, shown(REGISTER_POSITION_X));
    TEST_ASSERT_EQUAL_INT64(PANEL_ALARM_PROGRAM, shown(REGISTER_ALARM));
    TEST_ASSERT_EQUAL_INT64(3, shown(REGISTER_ALARM_LINE));
    TEST_ASSERT_NOT_NULL(strstr(alarm_text(), "travel"));
    TEST_ASSERT_EQUAL_INT64(PANEL_OUTCOME_FAILED, shown(REGISTER_OUTCOME));
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_CYCLE_START, 1));
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_ACKNOWLEDGE, 1));
    must(REGISTER_RESET, 1);
    TEST_ASSERT_EQUAL_INT(PANEL_IDLE, takt_service_get_state(&service));
    TEST_ASSERT_EQUAL_INT64(PANEL_ALARM_NONE, shown(REGISTER_ALARM));
}

static void test_a_line_runs_and_keeps_its_parameters(void)
{
    start_line("G10 L2 P1 X5");
    TEST_ASSERT_EQUAL_INT(PANEL_MDI, takt_service_get_state(&service));
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(5000, shown(REGISTER_WORK_OFFSET_X));
    start_line("G0 X2");
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(7000, shown(REGISTER_POSITION_X));
}

static void run_line(const char *text)
{
    start_line(text);
    wait_for(PANEL_IDLE);
}

static void test_a_line_goes_on_with_the_modes_of_the_line_before(void)
{
    run_line("G91 G1 F600 X2");
    run_line("X3");
    TEST_ASSERT_EQUAL_INT64(5000, shown(REGISTER_POSITION_X));
    run_line("G20");
    run_line("X1");
    TEST_ASSERT_EQUAL_INT64(30400, shown(REGISTER_POSITION_X));
    must(REGISTER_RESET, 1);
    run_line("G0 X1");
    TEST_ASSERT_EQUAL_INT64(1000, shown(REGISTER_POSITION_X));
}

static void test_a_program_between_lines_ends_their_modes(void)
{
    run_line("G91 G20 G0 X1");
    load("G0 X2\nG91\nM2\n");
    must(REGISTER_MODE, PANEL_MODE_PROGRAM);
    run_program();
    TEST_ASSERT_EQUAL_INT64(2000, shown(REGISTER_POSITION_X));
    run_line("G0 X3");
    TEST_ASSERT_EQUAL_INT64(3000, shown(REGISTER_POSITION_X));
}

static void test_jogs_and_homing_neither_use_nor_change_the_modes_of_lines(void)
{
    run_line("G91 G20 G0 X1");
    must(REGISTER_MODE, PANEL_MODE_JOG);
    must(REGISTER_JOG_DISTANCE, 2500);
    must(REGISTER_JOG_PLUS, 1);
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(27900, shown(REGISTER_POSITION_X));
    run_line("G0 X1");
    TEST_ASSERT_EQUAL_INT64(53300, shown(REGISTER_POSITION_X));
}

static void test_a_line_does_not_go_on_with_cutter_compensation(void)
{
    run_line("G41.1 D4");
    run_line("G1 F1000 X10");
    run_line("Y10");
    TEST_ASSERT_EQUAL_INT64(10000, shown(REGISTER_POSITION_X));
    TEST_ASSERT_EQUAL_INT64(10000, shown(REGISTER_POSITION_Y));
}

static void test_each_start_needs_its_mode(void)
{
    load("M2\n");
    must(REGISTER_MODE, PANEL_MODE_JOG);
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_CYCLE_START, 1));
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_MDI_START, 1));
    must(REGISTER_MODE, PANEL_MODE_PROGRAM);
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_JOG_PLUS, 1));
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_HOME, 1));
}

static void test_a_program_is_taken_in_idle_alone(void)
{
    must(REGISTER_EMERGENCY_STOP, 1);
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_UPLOAD_COMMAND, 2));
    must(REGISTER_EMERGENCY_STOP, 0);
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_UPLOAD_COMMAND, 4));
}

static void test_the_start_line_of_a_program_is_not_that_of_the_next(void)
{
    load("M2\n");
    must(REGISTER_START_LINE, 3);
    load("G21 F600\nG1 X1\nM2\n");
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_START_LINE));
}

static void test_coolant_stays_off_in_an_emergency_stop(void)
{
    must(REGISTER_FLOOD, 1);
    must(REGISTER_EMERGENCY_STOP, 1);
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_FLOOD, 1));
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_MIST, 1));
    must(REGISTER_FLOOD, 0);
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_COOLANT));
}

static void test_homing_takes_all_axes_to_zero(void)
{
    start_line("G0 X3 Y2 Z1");
    wait_for(PANEL_IDLE);
    must(REGISTER_MODE, PANEL_MODE_JOG);
    must(REGISTER_HOME, 1);
    TEST_ASSERT_EQUAL_INT(PANEL_HOMING, takt_service_get_state(&service));
    wait_for(PANEL_IDLE);
    for (unsigned i = 0; i < 3; i++)
        TEST_ASSERT_EQUAL_INT64(0, shown((enum panel_id)(REGISTER_POSITION_X + i)));
}

static void test_an_emergency_stop_ends_in_idle_where_the_drives_stand(void)
{
    int64_t at;

    load("G21 F6000\nG1 X300\nM2\n");
    must(REGISTER_CYCLE_START, 1);
    for (int i = 0; i < 500; i++)
        cycle();
    must(REGISTER_EMERGENCY_STOP, 1);
    TEST_ASSERT_EQUAL_INT(PANEL_EMERGENCY, takt_service_get_state(&service));
    TEST_ASSERT_EQUAL_INT64(PANEL_ALARM_EMERGENCY, shown(REGISTER_ALARM));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_EMERGENCY_STOP, service.alarm_text.code);
    TEST_ASSERT_EQUAL_INT64(PANEL_OUTCOME_ABORTED, shown(REGISTER_OUTCOME));
    for (int i = 0; i < 1000; i++)
        cycle();
    at = shown(REGISTER_ACTUAL_X);
    TEST_ASSERT_TRUE(at > 10000 && at < 100000);
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_RESET, 1));
    must(REGISTER_EMERGENCY_STOP, 0);
    TEST_ASSERT_EQUAL_INT(PANEL_ALARM, takt_service_get_state(&service));
    must(REGISTER_RESET, 1);
    wait_for(PANEL_IDLE);
    TEST_ASSERT_INT64_WITHIN(50, at, shown(REGISTER_ACTUAL_X));
    TEST_ASSERT_INT64_WITHIN(50, at, shown(REGISTER_POSITION_X));
    start_line("G0 X0");
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_POSITION_X));
    TEST_ASSERT_EQUAL_INT64(PANEL_ALARM_NONE, shown(REGISTER_ALARM));
}

static void test_a_refused_order_has_changed_nothing(void)
{
    const struct panel_order both = {
        .count = 3,
        .item = {{REGISTER_FEED_OVERRIDE, 500},
                 {REGISTER_TOOL_SELECT, 9},
                 {REGISTER_TOOL_DIAMETER, 1}},
    };

    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_VALUE, takt_service_order(&service, &both));
    TEST_ASSERT_EQUAL_INT64(1000, shown(REGISTER_FEED_OVERRIDE));
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_TOOL_SELECT));
}

static void test_a_tool_selected_and_set_in_one_order_is_that_tool(void)
{
    const struct panel_order both = {
        .count = 3,
        .item = {{REGISTER_TOOL_SELECT, 3},
                 {REGISTER_TOOL_OFFSET_Z, 20500},
                 {REGISTER_TOOL_DIAMETER, 6000}},
    };

    TEST_ASSERT_EQUAL_INT(PANEL_DONE, takt_service_order(&service, &both));
    TEST_ASSERT_EQUAL_DOUBLE(20.5, tools[0].offset.at[AXIS_Z]);
    TEST_ASSERT_EQUAL_DOUBLE(6.0, tools[0].diameter_mm);
    TEST_ASSERT_EQUAL_INT64(20500, shown(REGISTER_TOOL_OFFSET_Z));
    must(REGISTER_TOOL_SELECT, 4);
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_TOOL_OFFSET_Z));
}

static void test_two_buttons_at_once_are_refused(void)
{
    const struct panel_order both = {.count = 2,
                                     .item = {{REGISTER_CYCLE_START, 1}, {REGISTER_RESET, 1}}};

    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_VALUE, takt_service_order(&service, &both));
}

static void test_a_silent_panel_in_control_raises_an_alarm_and_loses_it(void)
{
    must(REGISTER_WATCHDOG, 100);
    for (int i = 0; i < 90; i++)
        cycle();
    takt_service_alive(&service);
    for (int i = 0; i < 90; i++)
        cycle();
    TEST_ASSERT_EQUAL_INT64(100, shown(REGISTER_WATCHDOG));
    for (int i = 0; i < 20; i++)
        cycle();
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_WATCHDOG));
    TEST_ASSERT_EQUAL_INT64(PANEL_ALARM_PANEL, shown(REGISTER_ALARM));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_PANEL_SILENT, service.alarm_text.code);
    load("M2\n");
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_CYCLE_START, 1));
    must(REGISTER_ACKNOWLEDGE, 1);
    must(REGISTER_CYCLE_START, 1);
}

static void test_switches_of_the_correction_reach_it(void)
{
    must(REGISTER_CORRECTION_SETUP, 0);
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_CORRECTION_SETUP));
    TEST_ASSERT_EQUAL_INT64(1, shown(REGISTER_CORRECTION_MATRIX));
    must(REGISTER_RISE_Z, -1500);
    TEST_ASSERT_EQUAL_INT64(-1500, shown(REGISTER_RISE_Z));
}

static void test_a_fault_of_a_drive_is_an_alarm_that_reset_leads_out_of(void)
{
    start_line("G0 X2");
    wait_for(PANEL_IDLE);
    takt_drives_stop_at_once(&service.controller.drives, TAKT_ERROR_DRIVE_FAULT);
    wait_for(PANEL_ALARM);
    TEST_ASSERT_EQUAL_INT64(PANEL_ALARM_DRIVE, shown(REGISTER_ALARM));
    must(REGISTER_RESET, 1);
    wait_for(PANEL_IDLE);
    TEST_ASSERT_INT64_WITHIN(20, 2000, shown(REGISTER_POSITION_X));
}

/* The spindle turns, and a cut is under way. */
static void cut(void)
{
    load("G21 F600\nG1 X10\nM2\n");
    must(REGISTER_CYCLE_START, 1);
    cycle();
    service.controller.outputs.spindle_speed_rpm = 6000;
    for (int i = 0; i < 100; i++)
        cycle();
    TEST_ASSERT_EQUAL_INT(PANEL_RUNNING, takt_service_get_state(&service));
}

static void test_a_spindle_lost_in_a_cut_holds_with_an_alarm_until_acknowledged(void)
{
    cut();
    world.spindle.silent = true;
    world.spindle.at_speed = false;
    cycle();
    TEST_ASSERT_EQUAL_INT(PANEL_HELD, takt_service_get_state(&service));
    TEST_ASSERT_EQUAL_INT64(PANEL_HOLD_SPINDLE, shown(REGISTER_HOLD_REASON));
    TEST_ASSERT_EQUAL_INT64(PANEL_ALARM_SPINDLE, shown(REGISTER_ALARM));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_SPINDLE_SILENT, service.alarm_text.code);
    world.spindle.silent = false;
    world.spindle.at_speed = true;
    cycle();
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_RESUME, 1));
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_CYCLE_START, 1));
    must(REGISTER_ACKNOWLEDGE, 1);
    must(REGISTER_RESUME, 1);
    TEST_ASSERT_EQUAL_INT(PANEL_RUNNING, takt_service_get_state(&service));
}

static void test_an_acknowledged_trip_resets_the_drive_and_waits_for_its_speed(void)
{
    cut();
    world.spindle.tripped = true;
    world.spindle.at_speed = false;
    cycle();
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_SPINDLE_TRIPPED, service.alarm_text.code);
    TEST_ASSERT_FALSE(takt_service_take_spindle_reset(&service));
    must(REGISTER_ACKNOWLEDGE, 1);
    TEST_ASSERT_TRUE(takt_service_take_spindle_reset(&service));
    TEST_ASSERT_FALSE(takt_service_take_spindle_reset(&service));
    world.spindle.tripped = false;
    cycle();
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_RESUME, 1));
    world.spindle.at_speed = true;
    cycle();
    must(REGISTER_RESUME, 1);
}

static void test_the_spindle_override_scales_the_commanded_speed(void)
{
    service.controller.outputs.spindle_speed_rpm = -6000;
    must(REGISTER_SPINDLE_OVERRIDE, 800);
    TEST_ASSERT_EQUAL_DOUBLE(-4800, takt_service_get_outputs(&service).spindle_speed_rpm);
    TEST_ASSERT_EQUAL_INT64(-48000, shown(REGISTER_SPINDLE_COMMANDED));
}

static void test_homing_that_is_stopped_is_an_alarm(void)
{
    for (int i = 0; i < 3; i++)
        service.controller.machine.axis[i].home_order = 1;
    must(REGISTER_MODE, PANEL_MODE_JOG);
    must(REGISTER_HOME, 1);
    cycle();
    TEST_ASSERT_EQUAL_INT(PANEL_HOMING, takt_service_get_state(&service));
    must(REGISTER_FEED_HOLD, 1);
    wait_for(PANEL_ALARM);
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_HOMING_STOPPED, service.alarm_text.code);
}

static void test_homing_finds_the_homes_of_the_drives_first(void)
{
    for (int i = 0; i < 3; i++)
        service.controller.machine.axis[i].home_order = 1;
    start_line("G0 X3");
    wait_for(PANEL_IDLE);
    must(REGISTER_MODE, PANEL_MODE_JOG);
    must(REGISTER_HOME, 1);
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(PANEL_OUTCOME_COMPLETED, shown(REGISTER_OUTCOME));
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_POSITION_X));
    TEST_ASSERT_INT64_WITHIN(20, 0, shown(REGISTER_ACTUAL_X));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_program_is_taken_started_and_run_to_its_end);
    RUN_TEST(test_the_same_program_from_the_same_place_has_the_same_digest);
    RUN_TEST(test_a_program_begins_where_the_axes_stand);
    RUN_TEST(test_an_error_ends_the_program_after_what_stands_before_it);
    RUN_TEST(test_a_line_runs_and_keeps_its_parameters);
    RUN_TEST(test_a_line_goes_on_with_the_modes_of_the_line_before);
    RUN_TEST(test_a_program_between_lines_ends_their_modes);
    RUN_TEST(test_jogs_and_homing_neither_use_nor_change_the_modes_of_lines);
    RUN_TEST(test_a_line_does_not_go_on_with_cutter_compensation);
    RUN_TEST(test_each_start_needs_its_mode);
    RUN_TEST(test_homing_takes_all_axes_to_zero);
    RUN_TEST(test_an_emergency_stop_ends_in_idle_where_the_drives_stand);
    RUN_TEST(test_a_refused_order_has_changed_nothing);
    RUN_TEST(test_a_tool_selected_and_set_in_one_order_is_that_tool);
    RUN_TEST(test_two_buttons_at_once_are_refused);
    RUN_TEST(test_a_silent_panel_in_control_raises_an_alarm_and_loses_it);
    RUN_TEST(test_switches_of_the_correction_reach_it);
    RUN_TEST(test_a_fault_of_a_drive_is_an_alarm_that_reset_leads_out_of);
    RUN_TEST(test_a_spindle_lost_in_a_cut_holds_with_an_alarm_until_acknowledged);
    RUN_TEST(test_an_acknowledged_trip_resets_the_drive_and_waits_for_its_speed);
    RUN_TEST(test_the_spindle_override_scales_the_commanded_speed);
    RUN_TEST(test_homing_that_is_stopped_is_an_alarm);
    RUN_TEST(test_homing_finds_the_homes_of_the_drives_first);
    RUN_TEST(test_a_program_is_taken_in_idle_alone);
    RUN_TEST(test_the_start_line_of_a_program_is_not_that_of_the_next);
    RUN_TEST(test_coolant_stays_off_in_an_emergency_stop);
    return UNITY_END();
}
