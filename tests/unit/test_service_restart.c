/*
 * One program after another: what is given up or stopped at once leaves nothing behind that the
 * next one would go by.
 */
#include "program/parameters.h"
#include "service_bench.h"

#define JOG_STEP_MM 0.02 /* more than 600 mm/min make of a cycle */

void setUp(void)
{
    bench_set_up_machine();
}

void tearDown(void)
{
}

static void run(unsigned cycles)
{
    for (unsigned i = 0; i < cycles; i++)
        cycle();
}

static void start_jog(enum axis axis, enum panel_id direction)
{
    must(REGISTER_MODE, PANEL_MODE_JOG);
    must(REGISTER_JOG_AXIS, axis);
    must(REGISTER_JOG_FEED, 600);
    must(REGISTER_WATCHDOG, 60000);
    must(direction, 1);
}

static bool take_pulse(void *context, const struct step_pulse *pulse)
{
    (void)context;
    (void)pulse;
    return true;
}

/* Every axis of the bench is a step drive. */
static void start_with_steps(void)
{
    step_port = (struct step_port){.pulse = take_pulse};
    for (unsigned i = 0; i < BENCH_DRIVES; i++) {
        machine.axis[i].drive_type = MACHINE_DRIVE_STEP;
        machine.axis[i].steps_per_mm = 1000;
        machine.axis[i].step_rate_max_hz = 200000;
    }
    bench_start();
}

static void run_line(const char *line)
{
    start_line(line);
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT(PANEL_OUTCOME_COMPLETED, shown(REGISTER_OUTCOME));
}

static void push_emergency_stop(unsigned cycles)
{
    must(REGISTER_EMERGENCY_STOP, 1);
    run(cycles);
    must(REGISTER_EMERGENCY_STOP, 0);
    TEST_ASSERT_EQUAL_INT(PANEL_ALARM, takt_service_get_state(&service));
}

/* Until it is idle again no axis jumps. */
static void expect_even_way(double most_mm)
{
    struct point before = service.controller.record.set;

    for (unsigned i = 0; i < BENCH_CYCLES_MAX && takt_service_get_state(&service) != PANEL_IDLE;
         i++) {
        cycle();
        for (unsigned k = 0; k < BENCH_DRIVES; k++)
            TEST_ASSERT_DOUBLE_WITHIN(most_mm, before.at[k], service.controller.record.set.at[k]);
        before = service.controller.record.set;
    }
    TEST_ASSERT_EQUAL_INT(PANEL_IDLE, takt_service_get_state(&service));
}

static void test_a_jog_behind_one_that_is_given_up_goes_on_its_own_line(void)
{
    machine.interpolator = INTERPOLATOR_INTEGRATE;
    bench_start();
    start_jog(AXIS_X, REGISTER_JOG_PLUS);
    run(500);
    must(REGISTER_JOG_PLUS, 0);
    wait_for(PANEL_IDLE);
    must(REGISTER_JOG_DISTANCE, 5000);
    start_jog(AXIS_Y, REGISTER_JOG_PLUS);
    expect_even_way(JOG_STEP_MM);
    TEST_ASSERT_EQUAL_INT64(5000, shown(REGISTER_POSITION_Y));
}

static void test_an_arc_behind_one_that_is_given_up_goes_round_its_own_centre(void)
{
    machine.interpolator = INTERPOLATOR_ROTATE;
    bench_start();
    load("G21 G90 F600\nG2 X40 I20\nM2\n");
    must(REGISTER_CYCLE_START, 1);
    run(500);
    must(REGISTER_RESET, 1);
    wait_for(PANEL_IDLE);
    load("G21 G91 F600\nG3 X2 Y2 J2\nM2\n");
    must(REGISTER_CYCLE_START, 1);
    expect_even_way(JOG_STEP_MM);
    TEST_ASSERT_EQUAL_INT64(PANEL_OUTCOME_COMPLETED, shown(REGISTER_OUTCOME));
}

static void test_after_an_emergency_stop_step_drives_go_on_from_where_they_stand(void)
{
    start_with_steps();
    run_line("G0 X5 Y0.1 Z-1");
    push_emergency_stop(300);
    must(REGISTER_RESET, 1);
    expect_even_way(0);
    run(10);
    TEST_ASSERT_EQUAL_STRING("", alarm_text());
    TEST_ASSERT_EQUAL_INT64(5000, shown(REGISTER_POSITION_X));
    TEST_ASSERT_EQUAL_INT64(100, shown(REGISTER_POSITION_Y));
    TEST_ASSERT_EQUAL_INT64(-1000, shown(REGISTER_POSITION_Z));
    run_line("G0 X4");
    TEST_ASSERT_EQUAL_INT64(4000, shown(REGISTER_POSITION_X));
}

static void test_step_drives_that_brake_are_left_alone_until_they_stand(void)
{
    start_with_steps();
    load("G21 G90 F3000\nG1 X50\nM2\n");
    must(REGISTER_CYCLE_START, 1);
    run(500);
    push_emergency_stop(10);
    TEST_ASSERT_EQUAL_INT(PANEL_WRONG_STATE, order(REGISTER_RESET, 1));
    run(500);
    must(REGISTER_RESET, 1);
    expect_even_way(0);
    TEST_ASSERT_EQUAL_STRING("", alarm_text());
}

static void test_positions_of_step_drives_are_shown(void)
{
    start_with_steps();
    run_line("G1 X0.1 F600");
    run(DRIVES_LATENCY_CYCLES);
    TEST_ASSERT_EQUAL_INT64(100, shown(REGISTER_ACTUAL_X));
    TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_FOLLOWING_X));
}

static void test_until_drives_report_again_they_are_shown_where_they_were(void)
{
    bench_start();
    run_line("G0 X5 Y-4 Z3");
    run(200);
    push_emergency_stop(300);
    must(REGISTER_RESET, 1);
    for (unsigned i = 0; i < BENCH_CYCLES_MAX && takt_service_get_state(&service) != PANEL_IDLE;
         i++) {
        TEST_ASSERT_INT64_WITHIN(1, 5000, shown(REGISTER_POSITION_X));
        TEST_ASSERT_INT64_WITHIN(1, -4000, shown(REGISTER_POSITION_Y));
        TEST_ASSERT_INT64_WITHIN(1, 3000, shown(REGISTER_ACTUAL_Z));
        TEST_ASSERT_INT64_WITHIN(1, 0, shown(REGISTER_FOLLOWING_X));
        cycle();
    }
    TEST_ASSERT_EQUAL_INT(PANEL_IDLE, takt_service_get_state(&service));
}

static void test_every_jog_is_stepped_by_the_evaluation_function_of_its_line(void)
{
    machine.step_form = STEPS_IMPROVED;
    start_with_steps();
    must(REGISTER_JOG_DISTANCE, 1000);
    for (enum axis axis = AXIS_X; axis <= AXIS_Z; axis++) {
        start_jog(axis, REGISTER_JOG_PLUS);
        run(60);
        TEST_ASSERT_TRUE(service.controller.steps.path.active);
        TEST_ASSERT_EQUAL_DOUBLE(1, service.controller.steps.path.curve.end.at[axis]);
        wait_for(PANEL_IDLE);
        TEST_ASSERT_EQUAL_INT64(1000, shown((enum panel_id)(REGISTER_POSITION_X + axis)));
    }
}

static double parameter(unsigned number)
{
    return takt_parameters_get(&parameters, number);
}

/* The program is given up in a line, and idle. */
static void give_up_in(const char *text, int64_t line)
{
    load(text);
    must(REGISTER_CYCLE_START, 1);
    for (unsigned i = 0; i < BENCH_CYCLES_MAX && shown(REGISTER_ACTIVE_LINE) != line; i++)
        cycle();
    run(20);
    TEST_ASSERT_EQUAL_INT64(line, shown(REGISTER_ACTIVE_LINE));
    must(REGISTER_RESET, 1);
    wait_for(PANEL_IDLE);
    run(1);
    TEST_ASSERT_EQUAL_INT64(line, shown(REGISTER_CUT_LINE));
    TEST_ASSERT_EQUAL_STRING("", alarm_text());
}

static const char offsets[] =
    "F600\nG1 X20\nG10 L2 P1 X50 Y7\nG1 X0\nG92 Z5\nG28.1\nG55\nG1 Z1\nM2\n";

static void test_offsets_of_lines_that_were_not_reached_do_not_count(void)
{
    bench_start();
    give_up_in(offsets, 2);
    TEST_ASSERT_EQUAL_DOUBLE(0, parameter(PARAMETER_SYSTEM_OFFSET));
    TEST_ASSERT_EQUAL_DOUBLE(0, parameter(PARAMETER_SYSTEM_OFFSET + 1));
    TEST_ASSERT_EQUAL_DOUBLE(0, parameter(PARAMETER_AXIS_APPLIED));
    TEST_ASSERT_EQUAL_DOUBLE(0, parameter(PARAMETER_AXIS_OFFSET + 2));
    TEST_ASSERT_EQUAL_DOUBLE(0, parameter(PARAMETER_REFERENCE_1 + 2));
    TEST_ASSERT_EQUAL_DOUBLE(1, parameter(PARAMETER_SYSTEM));
    TEST_ASSERT_EQUAL_INT64(shown(REGISTER_POSITION_X), shown(REGISTER_WORK_POSITION_X));
    TEST_ASSERT_EQUAL_INT64(shown(REGISTER_POSITION_Z), shown(REGISTER_WORK_POSITION_Z));
}

static void test_offsets_of_lines_that_were_reached_count(void)
{
    bench_start();
    give_up_in(offsets, 4);
    TEST_ASSERT_EQUAL_DOUBLE(50, parameter(PARAMETER_SYSTEM_OFFSET));
    TEST_ASSERT_EQUAL_DOUBLE(7, parameter(PARAMETER_SYSTEM_OFFSET + 1));
    TEST_ASSERT_EQUAL_DOUBLE(0, parameter(PARAMETER_AXIS_APPLIED));
    TEST_ASSERT_EQUAL_INT64(shown(REGISTER_POSITION_X) - 50000, shown(REGISTER_WORK_POSITION_X));
}

static void test_an_offset_is_shown_from_where_it_counts(void)
{
    bench_start();
    load(offsets);
    must(REGISTER_CYCLE_START, 1);
    while (shown(REGISTER_ACTIVE_LINE) != 4) {
        TEST_ASSERT_EQUAL_INT64(0, shown(REGISTER_WORK_OFFSET_X));
        cycle();
    }
    TEST_ASSERT_EQUAL_INT64(50000, shown(REGISTER_WORK_OFFSET_X));
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(50000, shown(REGISTER_WORK_OFFSET_X));
    TEST_ASSERT_EQUAL_DOUBLE(1, parameter(PARAMETER_AXIS_APPLIED));
}

static void test_a_program_goes_on_from_its_cut_line_in_the_right_place(void)
{
    bench_start();
    load("F1200\nG1 X20\nG10 L20 P1 X0\nG1 X0\nX30\nM2\n");
    must(REGISTER_CYCLE_START, 1);
    run(500);
    must(REGISTER_RESET, 1);
    wait_for(PANEL_IDLE);
    must(REGISTER_START_LINE, shown(REGISTER_CUT_LINE));
    must(REGISTER_CYCLE_START, 1);
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(PANEL_OUTCOME_COMPLETED, shown(REGISTER_OUTCOME));
    TEST_ASSERT_EQUAL_INT64(50000, shown(REGISTER_POSITION_X));
}

static void test_an_emergency_stop_and_a_fault_of_the_program_take_back_as_much(void)
{
    bench_start();
    load(offsets);
    must(REGISTER_CYCLE_START, 1);
    run(500);
    push_emergency_stop(500);
    TEST_ASSERT_EQUAL_DOUBLE(0, parameter(PARAMETER_SYSTEM_OFFSET));
    must(REGISTER_RESET, 1);
    wait_for(PANEL_IDLE);
    load("F600\nG1 X1\nG10 L2 P1 X50\nG1 Q\n");
    must(REGISTER_CYCLE_START, 1);
    wait_for(PANEL_ALARM);
    run(1);
    TEST_ASSERT_EQUAL_DOUBLE(50, parameter(PARAMETER_SYSTEM_OFFSET)); /* the line was reached */
}

/* Each round, stops and smoothed motions count for themselves. */
static void test_rounds_of_a_loop_are_told_from_each_other(void)
{
    static const char text[] = "G64 P0.05 F600\nO1 repeat [20]\nG91 G1 X1\nY1\nX-1\nY-1\nM3\nG90\n"
                               "G10 L2 P2 X[#5241+1]\nM0\nO1 endrepeat\nM2\n";

    bench_start();
    for (unsigned rounds = 0; rounds < 4; rounds++) {
        takt_parameters_clear(&parameters);
        load(text);
        must(REGISTER_CYCLE_START, 1);
        for (unsigned i = 0; i < rounds; i++) {
            wait_for(PANEL_HELD);
            must(REGISTER_RESUME, 1);
            wait_for(PANEL_RUNNING);
        }
        run(50);
        must(REGISTER_RESET, 1);
        wait_for(PANEL_IDLE);
        run(1);
        TEST_ASSERT_EQUAL_DOUBLE(rounds,
                                 parameter(PARAMETER_SYSTEM_OFFSET + PARAMETER_SYSTEM_STRIDE));
    }
}

static void test_changes_inside_a_compensated_contour_count_where_they_stand(void)
{
    static const char text[] =
        "F600 G10 L1 P3 R1\nT3 M6\nG41 D3 G1 X10 Y5\nX20\nG10 L2 P2 X1\nX30\n"
        "G10 L2 P2 X2\nY20\nG10 L2 P2 X3\nX10\nG40 X0 Y0\nM2\n";

    bench_start();
    give_up_in(text, 4);
    TEST_ASSERT_EQUAL_DOUBLE(0, parameter(PARAMETER_SYSTEM_OFFSET + PARAMETER_SYSTEM_STRIDE));
    run_line("G0 X0 Y0");
    must(REGISTER_MODE, PANEL_MODE_PROGRAM);
    give_up_in(text, 6);
    TEST_ASSERT_EQUAL_DOUBLE(1, parameter(PARAMETER_SYSTEM_OFFSET + PARAMETER_SYSTEM_STRIDE));
    run_line("G0 X0 Y0");
    must(REGISTER_MODE, PANEL_MODE_PROGRAM);
    give_up_in(text, 10);
    TEST_ASSERT_EQUAL_DOUBLE(3, parameter(PARAMETER_SYSTEM_OFFSET + PARAMETER_SYSTEM_STRIDE));
}

static void test_changes_around_questions_and_restored_modes_count_where_they_stand(void)
{
    static const char text[] =
        "F600\nM66 P0 L0\nG38.3 X5\nG10 L20 P1 X0\nM66 P0 L0\nG1 X20\nO1 sub\nM70\nG55\nG1 Y20\n"
        "M72\nO1 endsub\nO1 call\nG10 L2 P3 X1\nG1 X1\nM2\n";

    bench_start();
    give_up_in(text, 6);
    TEST_ASSERT_EQUAL_DOUBLE(5, parameter(PARAMETER_SYSTEM_OFFSET));
    TEST_ASSERT_EQUAL_DOUBLE(1, parameter(PARAMETER_SYSTEM));
    run_line("G53 G0 X0 Y0");
    must(REGISTER_MODE, PANEL_MODE_PROGRAM);
    give_up_in(text, 10);
    TEST_ASSERT_EQUAL_DOUBLE(2, parameter(PARAMETER_SYSTEM));
    TEST_ASSERT_EQUAL_DOUBLE(0, parameter(PARAMETER_SYSTEM_OFFSET + 2 * PARAMETER_SYSTEM_STRIDE));
}

static void test_tools_of_lines_that_were_not_reached_stay_as_they_are(void)
{
    static const char text[] = "F600\nG1 X20\nG10 L1 P3 Z12\nG1 X0\nM2\n";

    bench_start();
    give_up_in(text, 2);
    TEST_ASSERT_EQUAL_DOUBLE(0, tools[0].offset.at[AXIS_Z]);
    give_up_in(text, 4);
    TEST_ASSERT_EQUAL_DOUBLE(12, tools[0].offset.at[AXIS_Z]);
}

/* More than are kept: it is said. */
static void test_changes_that_cannot_be_taken_back_are_an_alarm(void)
{
    bench_start();
    load("F60\nG1 X1\nO1 repeat [100]\nG10 L2 P2 X[#5241+1]\nG1 X[2-#<_x>]\nO1 endrepeat\nM2\n");
    must(REGISTER_CYCLE_START, 1);
    run(500);
    must(REGISTER_RESET, 1);
    for (unsigned i = 0; i < 500; i++)
        cycle();
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_CHANGES_AHEAD, service.alarm_text.code);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_jog_behind_one_that_is_given_up_goes_on_its_own_line);
    RUN_TEST(test_an_arc_behind_one_that_is_given_up_goes_round_its_own_centre);
    RUN_TEST(test_after_an_emergency_stop_step_drives_go_on_from_where_they_stand);
    RUN_TEST(test_step_drives_that_brake_are_left_alone_until_they_stand);
    RUN_TEST(test_positions_of_step_drives_are_shown);
    RUN_TEST(test_every_jog_is_stepped_by_the_evaluation_function_of_its_line);
    RUN_TEST(test_until_drives_report_again_they_are_shown_where_they_were);
    RUN_TEST(test_offsets_of_lines_that_were_not_reached_do_not_count);
    RUN_TEST(test_offsets_of_lines_that_were_reached_count);
    RUN_TEST(test_an_offset_is_shown_from_where_it_counts);
    RUN_TEST(test_a_program_goes_on_from_its_cut_line_in_the_right_place);
    RUN_TEST(test_an_emergency_stop_and_a_fault_of_the_program_take_back_as_much);
    RUN_TEST(test_rounds_of_a_loop_are_told_from_each_other);
    RUN_TEST(test_changes_inside_a_compensated_contour_count_where_they_stand);
    RUN_TEST(test_changes_around_questions_and_restored_modes_count_where_they_stand);
    RUN_TEST(test_tools_of_lines_that_were_not_reached_stay_as_they_are);
    RUN_TEST(test_changes_that_cannot_be_taken_back_are_an_alarm);
    return UNITY_END();
}
