/*
 * firmware/service/service.h: position-error correction that goes on from one program to the next
 * and between them, and is switched by the operator.
 */
#include "service_verifier.h"

/* K_X = X / 2000 by the matrix: 0.05 mm at X 100. */
#define PITCH 5e-4

/* All fades have ended after this many cycles. */
#define SETTLED 4000U

void setUp(void)
{
    bench_set_up_machine();
    machine.correction.machine[AXIS_X][AXIS_X] = PITCH;
    machine.correction.reserve_ratio = 0.05;
    bench_start();
    begin_judging();
}

void tearDown(void)
{
}

/* What is added to the commanded place. */
static double correction_now(void)
{
    return service.controller.record.set.at[AXIS_X] - service.at.at[AXIS_X];
}

static void run_line(const char *line)
{
    start_line(line);
    verified_wait_for(PANEL_IDLE);
}

static void test_correction_lasts_from_one_program_to_the_next_without_a_jump(void)
{
    verified_cycles(SETTLED);
    run_line("G0 X100");
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, 100 * PITCH, correction_now());
    run_line("G0 X60");
    must(REGISTER_MODE, PANEL_MODE_JOG);
    must(REGISTER_JOG_DISTANCE, 20000);
    must(REGISTER_JOG_PLUS, 1);
    verified_wait_for(PANEL_IDLE);
    load("G21 F6000\nG1 X200\nM2\n");
    must(REGISTER_MODE, PANEL_MODE_PROGRAM);
    must(REGISTER_CYCLE_START, 1);
    verified_wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT64(200000, shown(REGISTER_POSITION_X));
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, 200 * PITCH, correction_now());
    expect_limits_kept();
}

static void test_layers_fade_in_and_out_while_the_axes_stand(void)
{
    run_line("G0 X100");
    verified_cycles(SETTLED);
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, 100 * PITCH, correction_now());
    TEST_ASSERT_EQUAL_INT64(100000, shown(REGISTER_POSITION_X));
    TEST_ASSERT_INT64_WITHIN(2, 0, shown(REGISTER_FOLLOWING_X));
    must(REGISTER_CORRECTION_MATRIX, 0);
    verified_cycles(SETTLED);
    TEST_ASSERT_EQUAL_DOUBLE(0, correction_now());
    must(REGISTER_CORRECTION_MATRIX, 1);
    verified_cycles(SETTLED);
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, 100 * PITCH, correction_now());
    expect_limits_kept();
}

static void test_a_layer_switched_in_a_cut_fades_within_the_limits(void)
{
    verified_cycles(SETTLED);
    load("G21 F6000\nG1 X400\nM2\n");
    must(REGISTER_CYCLE_START, 1);
    verified_cycles(1000);
    must(REGISTER_CORRECTION_MATRIX, 0);
    verified_cycles(2900);
    TEST_ASSERT_EQUAL_INT(PANEL_RUNNING, takt_service_get_state(&service));
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0, correction_now());
    verified_wait_for(PANEL_IDLE);
    expect_limits_kept();
}

/* A fade begun in a program goes on where nothing moves, and where a program waits to begin. */
static void test_a_program_that_ends_in_a_fade_and_one_that_begins_in_it_keep_the_limits(void)
{
    verified_cycles(SETTLED);
    run_line("G0 X300");
    must(REGISTER_CORRECTION_MATRIX, 0);
    verified_cycles(200);
    run_line("G0 X301");
    must(REGISTER_CORRECTION_MATRIX, 1);
    verified_cycles(150);
    run_line("G0 X302");
    verified_cycles(SETTLED);
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, 302 * PITCH, correction_now());
    expect_limits_kept();
}

static void test_an_error_of_a_program_does_not_stop_a_fade(void)
{
    run_line("G0 X300");
    must(REGISTER_CORRECTION_MATRIX, 0);
    verified_cycles(100);
    start_line("G1 X9999 F100");
    verified_wait_for(PANEL_ALARM);
    verified_cycles(SETTLED);
    TEST_ASSERT_EQUAL_DOUBLE(0, correction_now());
    expect_limits_kept();
}

static void test_a_program_switches_a_layer_and_the_next_has_it_again(void)
{
    verified_cycles(SETTLED);
    load("G21 F6000\nM121 P1\nG1 X100\nG4 P4\nM2\n");
    must(REGISTER_CYCLE_START, 1);
    verified_wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_DOUBLE(0, correction_now());
    load("G21\nG1 X100.001 F6000\nG4 P4\nM2\n");
    must(REGISTER_CYCLE_START, 1);
    verified_wait_for(PANEL_IDLE);
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, 100.001 * PITCH, correction_now());
    expect_limits_kept();
}

/*
 * The drives are enabled where they stand: what is there is taken for a commanded place, and
 * corrected from it on.
 */
static void test_a_set_up_fades_in_and_lasts_for_the_next_program(void)
{
    verified_cycles(SETTLED);
    run_line("G10 L13 X0.02");
    verified_cycles(2 * SETTLED);
    run_line("G0 X100");
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, 0.02 + 100 * PITCH, correction_now());
    load("G21 F6000\nG1 X200\nM2\n");
    must(REGISTER_MODE, PANEL_MODE_PROGRAM);
    must(REGISTER_CYCLE_START, 1);
    verified_wait_for(PANEL_IDLE);
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, 0.02 + 200 * PITCH, correction_now());
    expect_limits_kept();
}

static void test_a_set_up_beyond_what_is_reserved_is_an_alarm(void)
{
    verified_cycles(SETTLED);
    start_line("G10 L13 X900");
    for (unsigned i = 0;
         i < SETTLED && takt_controller_get_state(&service.controller) != CONTROLLER_FAULTED; i++)
        verified_cycles(1);
    TEST_ASSERT_EQUAL_INT(CONTROLLER_FAULTED, takt_controller_get_state(&service.controller));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_SETUP_RESERVE,
                          takt_controller_get_fault(&service.controller)->code);
}

static void test_after_a_fault_correction_fades_in_from_where_the_drives_stand(void)
{
    run_line("G0 X300");
    verified_cycles(SETTLED);
    takt_drives_stop_at_once(&service.controller.drives, TAKT_ERROR_DRIVE_FAULT);
    verified_wait_for(PANEL_ALARM);
    must(REGISTER_RESET, 1);
    wait_for(PANEL_IDLE);
    TEST_ASSERT_DOUBLE_WITHIN(0.002, 300 * (1 + PITCH), service.at.at[AXIS_X]);
    verifier_from_rest();
    verified_cycles(SETTLED);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 300 * PITCH * (1 + PITCH), correction_now());
    run_line("G0 X0");
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0, correction_now());
    expect_limits_kept();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_correction_lasts_from_one_program_to_the_next_without_a_jump);
    RUN_TEST(test_layers_fade_in_and_out_while_the_axes_stand);
    RUN_TEST(test_a_layer_switched_in_a_cut_fades_within_the_limits);
    RUN_TEST(test_a_program_that_ends_in_a_fade_and_one_that_begins_in_it_keep_the_limits);
    RUN_TEST(test_an_error_of_a_program_does_not_stop_a_fade);
    RUN_TEST(test_a_program_switches_a_layer_and_the_next_has_it_again);
    RUN_TEST(test_a_set_up_fades_in_and_lasts_for_the_next_program);
    RUN_TEST(test_a_set_up_beyond_what_is_reserved_is_an_alarm);
    RUN_TEST(test_after_a_fault_correction_fades_in_from_where_the_drives_stand);
    return UNITY_END();
}
