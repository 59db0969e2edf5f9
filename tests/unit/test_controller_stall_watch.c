/* The watch for setpoints that stand: what explains it, and when it is an alarm. */
#include "controller/stall_watch.h"

#include <string.h>
#include <unity.h>

static struct stall_watch watch;
static struct machine machine;

/* V/A + A/J = 0.1 + 0.02 s: at most 4 s. */
void setUp(void)
{
    memset(&machine, 0, sizeof(machine));
    machine.cycle_us = 1000;
    machine.axis[AXIS_X] = (struct machine_axis){.present = true,
                                                 .max_velocity_mm_s = 100,
                                                 .max_acceleration_mm_s2 = 1000,
                                                 .max_jerk_mm_s3 = 50000};
    stall_watch_init(&watch, &machine);
}

void tearDown(void)
{
}

/* Cycles until the alarm, at most so many. */
static unsigned cycles_until_alarm(double ratio, bool explained, double step_mm, unsigned most)
{
    struct point at = {{1}};
    unsigned cycles = 0;

    while (cycles < most && stall_watch_cycle(&watch, &at, ratio, explained)) {
        at.at[AXIS_X] += step_mm;
        cycles++;
    }
    return cycles;
}

static void test_standing_longer_than_ramps_take_is_an_alarm(void)
{
    TEST_ASSERT_UINT32_WITHIN(2, 4000, cycles_until_alarm(1, false, 0, 100000));
}

static void test_a_lower_override_explains_as_much_more_time(void)
{
    TEST_ASSERT_UINT32_WITHIN(2, 80000, cycles_until_alarm(0.05, false, 0, 100000));
}

static void test_an_override_of_0_and_what_holds_explain_any_time(void)
{
    TEST_ASSERT_EQUAL_UINT32(100000, cycles_until_alarm(0, false, 0, 100000));
    TEST_ASSERT_EQUAL_UINT32(100000, cycles_until_alarm(1, true, 0, 100000));
}

static void test_the_slowest_motion_is_motion(void)
{
    TEST_ASSERT_EQUAL_UINT32(100000, cycles_until_alarm(1, false, 1e-12, 100000));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_standing_longer_than_ramps_take_is_an_alarm);
    RUN_TEST(test_a_lower_override_explains_as_much_more_time);
    RUN_TEST(test_an_override_of_0_and_what_holds_explain_any_time);
    RUN_TEST(test_the_slowest_motion_is_motion);
    return UNITY_END();
}
