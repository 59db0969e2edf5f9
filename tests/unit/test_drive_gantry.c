/*
 * Two drives of one axis: brought together at the start, and watched.
 */
#include "starting_master.h"

#define SECOND 3 /* index; node 4 */

/* Fake nodes show one position for all: drives that count otherwise stand elsewhere. */
static void add_second(double increments_per_mm, double skew_max_mm)
{
    config.axis[SECOND] = config.axis[1];
    config.axis[SECOND].node = 4;
    config.axis[SECOND].increments_per_mm = increments_per_mm;
    config.axis[SECOND].homing.zero_mm_s = 2;
    config.axis[SECOND].homing.acceleration_mm_s2 = 500;
    config.count = 4;
    config.gantry_count = 1;
    config.gantry[0] = (struct drives_gantry){1, SECOND, skew_max_mm};
}

static void test_both_drives_of_an_axis_are_enabled(void)
{
    struct point actual;
    uint16_t statusword[AXIS_COUNT];
    shown_inc = 2000;
    add_second(1000, 0.5);
    run_start();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    drives_get_actual(&drives, &actual);
    takt_drives_get_statuswords(&drives, statusword);
    TEST_ASSERT_EQUAL_DOUBLE(2, actual.at[AXIS_Y]);
    TEST_ASSERT_EQUAL_HEX16(takt_cia402_statusword(CIA402_ENABLED) | CIA402_FOLLOWS_TARGET,
                            statusword[AXIS_Y]);
}

static void test_drives_too_far_apart_are_not_brought_together(void)
{
    shown_inc = 2000;
    add_second(1500, 0.5); /* 2 mm and 1.333 mm */
    run_start();
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_DRIVE_SKEW, takt_drives_get_fault(&drives)->code);
    assert_text("axis Y2 (node 4) is 0.666667 mm off the other drive of its gantry");
}

static void test_drives_that_part_brake_at_once(void)
{
    config.stop_timeout_cycles = 1000;
    add_second(1100, 0.1);
    for (unsigned i = 0; i < 4; i++)
        config.axis[i].following_error_max_mm = 0;
    run_start();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    shown_inc = 1000; /* 1 mm and 0.909 mm */
    cycle();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    shown_inc = 1200; /* 1.2 mm and 1.091 mm */
    cycle();
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_DRIVE_SKEW, takt_drives_get_fault(&drives)->code);
    TEST_ASSERT_EQUAL_INT(DRIVES_BRAKING, drives_get_state(&drives));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_both_drives_of_an_axis_are_enabled);
    RUN_TEST(test_drives_too_far_apart_are_not_brought_together);
    RUN_TEST(test_drives_that_part_brake_at_once);
    return UNITY_END();
}
