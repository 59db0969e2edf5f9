/*
 * Every fault of fault_cases.c, tried on the real controller: what comes of it, and that no axis is
 * left moving.
 */
#include "fault_run.h"
#include "unity.h"

#include <stdio.h>
#include <string.h>

/* A drive that holds its position hums by less than this. */
#define STILL_MM_S 0.01

static struct fault_result result;
static char message[512];

void setUp(void)
{
}

void tearDown(void)
{
}

static const char *tell(const struct fault_case *fault)
{
    (void)snprintf(message, sizeof message,
                   "%s: %s; rest after %.1f ms, %.4f mm off, %.6f mm/s at the end", fault->name,
                   result.completed ? "completed" : result.text, result.stop_ms, result.off_mm,
                   result.end_mm_s);
    return message;
}

static void run(const struct fault_case *fault)
{
    TEST_ASSERT_TRUE_MESSAGE(fault_run(fault, &result), result.text);
}

static void test_every_fault_comes_to_its_alarm_or_to_the_end_of_the_program(void)
{
    for (unsigned i = 0; i < fault_cases_count; i++) {
        const struct fault_case *fault = &fault_cases[i];
        run(fault);
        TEST_ASSERT_EQUAL_INT_MESSAGE(fault->alarm, result.alarm.code, tell(fault));
        TEST_ASSERT_EQUAL_INT_MESSAGE(fault->alarm == TAKT_OK, result.completed, tell(fault));
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, strncmp(result.text, fault->text, strlen(fault->text)),
                                      tell(fault));
    }
}

static void test_no_fault_leaves_an_axis_moving(void)
{
    for (unsigned i = 0; i < fault_cases_count; i++) {
        run(&fault_cases[i]);
        TEST_ASSERT_TRUE_MESSAGE(result.end_mm_s < STILL_MM_S, tell(&fault_cases[i]));
    }
}

static void test_axes_come_to_rest_in_time_and_near_the_path(void)
{
    for (unsigned i = 0; i < fault_cases_count; i++) {
        const struct fault_case *fault = &fault_cases[i];
        run(fault);
        if (fault->alarm != TAKT_OK) {
            TEST_ASSERT_TRUE_MESSAGE(result.stop_ms <= fault->stop_max_ms, tell(fault));
        }
        TEST_ASSERT_TRUE_MESSAGE(result.off_mm <= fault->off_max_mm, tell(fault));
    }
}

static void test_without_a_fault_the_tool_stays_on_the_path(void)
{
    static const struct fault_case nothing = {.name = "nothing", .script = "power bus drop id=7FE"};
    run(&nothing);
    TEST_ASSERT_TRUE_MESSAGE(result.completed, tell(&nothing));
    TEST_ASSERT_TRUE_MESSAGE(result.off_mm < 0.001, tell(&nothing));
}

static void test_a_run_with_faults_repeats_itself_bit_for_bit(void)
{
    static const struct fault_case noisy = {
        .name = "noise",
        .script = "enabled+0.1s bus corrupt ratio=0.05 seed=3 for=1s\n"
                  "enabled+0.1s bus drop ratio=0.01 seed=4 for=1s\n"};
    struct fault_result first;
    run(&noisy);
    first = result;
    run(&noisy);
    TEST_ASSERT_TRUE(first.off_mm == result.off_mm && first.stop_ms == result.stop_ms);
    TEST_ASSERT_EQUAL_STRING(first.text, result.text);
}

static void test_there_are_at_least_20_faults(void)
{
    TEST_ASSERT_TRUE(fault_cases_count >= 20);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_fault_comes_to_its_alarm_or_to_the_end_of_the_program);
    RUN_TEST(test_no_fault_leaves_an_axis_moving);
    RUN_TEST(test_axes_come_to_rest_in_time_and_near_the_path);
    RUN_TEST(test_without_a_fault_the_tool_stays_on_the_path);
    RUN_TEST(test_a_run_with_faults_repeats_itself_bit_for_bit);
    RUN_TEST(test_there_are_at_least_20_faults);
    return UNITY_END();
}
