/*
 * The controller compares its own cycle with what the machine's limits need.
 */
#include "base/maths.h"
#include "controller/controller.h"
#include "unity.h"

#include <string.h>

static struct machine machine;

void setUp(void)
{
    takt_machine_set_default(&machine);
}

void tearDown(void)
{
}

static void test_the_built_in_mill_needs_354_hz_and_has_1000(void)
{
    struct diagnostic warning;
    struct cycle_need need;

    /* sqrt(a / (8 d)) with a = 1000 mm/s2, d = 1 um: 353.6, at R = a^3 / J^2 = 0.4 mm */
    takt_controller_cycle_need(&machine, &need, NULL);
    TEST_ASSERT_DOUBLE_WITHIN(0.3, 353.6, need.frequency_hz);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.4, need.radius_mm);
    TEST_ASSERT_TRUE(takt_controller_cycle_is_enough(&machine, &warning));
    TEST_ASSERT_EQUAL_INT(TAKT_OK, warning.code);
}

static void test_a_cycle_that_is_too_slow_is_told_with_both_frequencies(void)
{
    struct diagnostic warning;
    char text[DIAGNOSTIC_TEXT_MAX];

    machine.cycle_us = 5000;
    TEST_ASSERT_FALSE(takt_controller_cycle_is_enough(&machine, &warning));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_CYCLE_SLOW, warning.code);
    (void)takt_diagnostic_text(&warning, text);
    TEST_ASSERT_NOT_NULL(strstr(text, "200 Hz is below the 353.8 Hz"));
}

static void test_the_plane_that_needs_most_counts(void)
{
    struct cycle_limits limits;
    struct cycle_need need;

    machine.axis[AXIS_X].max_acceleration_mm_s2 = 250.0; /* both planes with X need less */
    takt_controller_cycle_need(&machine, &need, &limits);
    TEST_ASSERT_DOUBLE_WITHIN(0.3, 353.6, need.frequency_hz);
    TEST_ASSERT_EQUAL_DOUBLE(1000.0, limits.acceleration_mm_s2);
    machine.axis[AXIS_Z].max_acceleration_mm_s2 =
        500.0; /* now Y and Z have 500, X and the others 250 */
    takt_controller_cycle_need(&machine, &need, &limits);
    /*
     * sqrt(500 / 0.008) = 250, and a little more, since R = 0.05 mm is not far above the tolerance
     */
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 251.3, need.frequency_hz);
    TEST_ASSERT_EQUAL_DOUBLE(500.0, limits.acceleration_mm_s2);
}

static void test_a_machine_without_a_plane_needs_nothing(void)
{
    struct diagnostic warning;
    struct cycle_need need;

    machine.axis[AXIS_X].present = machine.axis[AXIS_Z].present = false;
    machine.cycle_us = 10000;
    takt_controller_cycle_need(&machine, &need, NULL);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, need.frequency_hz);
    TEST_ASSERT_TRUE(takt_controller_cycle_is_enough(&machine, &warning));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_built_in_mill_needs_354_hz_and_has_1000);
    RUN_TEST(test_a_cycle_that_is_too_slow_is_told_with_both_frequencies);
    RUN_TEST(test_the_plane_that_needs_most_counts);
    RUN_TEST(test_a_machine_without_a_plane_needs_nothing);
    return UNITY_END();
}
