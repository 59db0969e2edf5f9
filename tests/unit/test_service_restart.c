/*
 * One program after another: what is given up or stopped at once leaves nothing behind that the
 * next one would go by.
 */
#include "base/maths.h"
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

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_jog_behind_one_that_is_given_up_goes_on_its_own_line);
    RUN_TEST(test_an_arc_behind_one_that_is_given_up_goes_round_its_own_centre);
    RUN_TEST(test_after_an_emergency_stop_step_drives_go_on_from_where_they_stand);
    RUN_TEST(test_step_drives_that_brake_are_left_alone_until_they_stand);
    RUN_TEST(test_positions_of_step_drives_are_shown);
    RUN_TEST(test_until_drives_report_again_they_are_shown_where_they_were);
    RUN_TEST(test_every_jog_is_stepped_by_the_evaluation_function_of_its_line);
    return UNITY_END();
}
