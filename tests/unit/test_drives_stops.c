/*
 * How the drive stops: by a change of mode, disable operation, shutdown, quick stop and fault, as
 * the option codes say.
 */
#include "drive_modes_bench.h"

static void run_at_40_mm_s(unsigned cycles)
{
    for (unsigned k = 1; k <= cycles; k++) {
        target_by_pdo((int32_t)lround(1000 * command_mm()) + 40);
        lone_step(&lone, 1);
    }
}

static void test_a_change_of_mode_in_motion_slows_down_and_stands(void)
{
    lone_enable(&lone, CSP);
    run_at_40_mm_s(200);
    double from_mm = command_mm();
    lone_control(&lone, ENABLE, PP);
    lone_step(&lone, 1);
    TEST_ASSERT_EQUAL_INT(CIA402_ENABLED, virtual_drive_get_state(&lone.drive));
    lone_step(&lone, 500);
    TEST_ASSERT_TRUE(lone.drive.servo.loop.command_velocity_mm_s == 0);
    TEST_ASSERT_TRUE(fabs(command_mm() - from_mm) < 2);
}

static enum cia402_state state_after(unsigned cycles)
{
    lone_step(&lone, cycles);
    return virtual_drive_get_state(&lone.drive);
}

/* 40 mm/s at 500 mm/s2: 80 ms and 1.6 mm. */
static void test_disable_operation_slows_down_first(void)
{
    lone_enable(&lone, CSP);
    run_at_40_mm_s(200);
    double from_mm = command_mm();
    lone_control(&lone, CIA402_SWITCH_ON, CSP);
    TEST_ASSERT_EQUAL_INT(CIA402_ENABLED, state_after(79));
    TEST_ASSERT_EQUAL_INT(CIA402_SWITCHED_ON, state_after(2));
    TEST_ASSERT_TRUE(fabs(command_mm() - from_mm - 1.6) < 0.05);
}

static void test_enable_operation_takes_disable_operation_back(void)
{
    lone_enable(&lone, CSP);
    run_at_40_mm_s(200);
    lone_control(&lone, CIA402_SWITCH_ON, CSP);
    lone_step(&lone, 10);
    lone_control(&lone, ENABLE, CSP);
    TEST_ASSERT_EQUAL_INT(CIA402_ENABLED, state_after(500));
}

static void test_shutdown_takes_the_torque_away_or_slows_down_as_605B_says(void)
{
    lone_enable(&lone, CSP);
    run_at_40_mm_s(200);
    lone_control(&lone, CIA402_SHUTDOWN, CSP);
    TEST_ASSERT_EQUAL_INT(CIA402_READY, virtual_drive_get_state(&lone.drive));
    setUp();
    (void)lone_write(&lone, 0x605B, 0, 2, 1);
    lone_enable(&lone, CSP);
    run_at_40_mm_s(200);
    lone_control(&lone, CIA402_SHUTDOWN, CSP);
    TEST_ASSERT_EQUAL_INT(CIA402_ENABLED, state_after(79));
    TEST_ASSERT_EQUAL_INT(CIA402_READY, state_after(2));
}

static void quick_stop_with(uint32_t option)
{
    setUp();
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x605A, 0, 2, option));
    lone_enable(&lone, CSP);
    run_at_40_mm_s(200);
    lone_control(&lone, CIA402_QUICK_STOP_NOW, CSP);
    TEST_ASSERT_EQUAL_INT(CIA402_QUICK_STOP, virtual_drive_get_state(&lone.drive));
}

/* 40 mm/s: 20 ms at 2000 mm/s2, 80 ms at 500 mm/s2. */
static void test_quick_stop_takes_its_ramp_and_its_end_from_605A(void)
{
    quick_stop_with(0);
    TEST_ASSERT_EQUAL_INT(CIA402_SWITCH_ON_DISABLED, state_after(1));
    quick_stop_with(1);
    TEST_ASSERT_EQUAL_INT(CIA402_QUICK_STOP, state_after(70));
    TEST_ASSERT_EQUAL_INT(CIA402_SWITCH_ON_DISABLED, state_after(100));
    quick_stop_with(2);
    TEST_ASSERT_EQUAL_INT(CIA402_SWITCH_ON_DISABLED, state_after(70));
    quick_stop_with(6);
    TEST_ASSERT_EQUAL_INT(CIA402_QUICK_STOP, state_after(1000));
    lone_control(&lone, ENABLE, CSP);
    TEST_ASSERT_EQUAL_INT(CIA402_ENABLED, state_after(100));
}

static void test_a_fault_takes_the_torque_away_at_once_if_605E_says_so(void)
{
    (void)lone_write(&lone, 0x605E, 0, 2, 0);
    lone_enable(&lone, CSP);
    target_by_pdo(5000);
    lone_step(&lone, 1);
    TEST_ASSERT_EQUAL_INT(CIA402_FAULT, state_after(1));
}

static void test_a_following_error_may_last_as_long_as_6066_says(void)
{
    (void)lone_write(&lone, 0x6065, 0, 4, 100);
    (void)lone_write(&lone, 0x6066, 0, 2, 50);
    lone.drive.plant.damage.is_jammed = true;
    lone_enable(&lone, CSP);
    target_by_pdo(500);
    TEST_ASSERT_EQUAL_INT(CIA402_ENABLED, state_after(50));
    TEST_ASSERT_EQUAL_INT(CIA402_FAULT_REACTION, state_after(1));
    setUp();
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, 0x6065, 0, 4, 0xFFFFFFFF));
    lone_enable(&lone, CSP);
    lone.drive.plant.damage.is_jammed = true;
    target_by_pdo(500000);
    TEST_ASSERT_EQUAL_INT(CIA402_ENABLED, state_after(500));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_change_of_mode_in_motion_slows_down_and_stands);
    RUN_TEST(test_disable_operation_slows_down_first);
    RUN_TEST(test_enable_operation_takes_disable_operation_back);
    RUN_TEST(test_shutdown_takes_the_torque_away_or_slows_down_as_605B_says);
    RUN_TEST(test_quick_stop_takes_its_ramp_and_its_end_from_605A);
    RUN_TEST(test_a_fault_takes_the_torque_away_at_once_if_605E_says_so);
    RUN_TEST(test_a_following_error_may_last_as_long_as_6066_says);
    return UNITY_END();
}
