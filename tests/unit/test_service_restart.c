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

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_jog_behind_one_that_is_given_up_goes_on_its_own_line);
    RUN_TEST(test_an_arc_behind_one_that_is_given_up_goes_round_its_own_centre);
    return UNITY_END();
}
