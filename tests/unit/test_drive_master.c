/*
 * The master of the drives, frame by frame: the way to "operation enabled", targets, positions.
 * test_drives_loop.c has the same master with virtual drives.
 */
#include "lone_master.h"

static void assert_controlword_in_turn(enum cia402_state state, uint16_t controlword)
{
    for (unsigned turn = 0; turn < 3; turn++) {
        unsigned controlwords = 0;
        put_all(state, 0);
        cycle();
        for (unsigned node = 1; node <= 3; node++) {
            const struct can_frame *frame = find_sent(0x200 + node);
            if (!frame)
                continue;
            controlwords++;
            TEST_ASSERT_EQUAL_INT(3, frame->length);
            TEST_ASSERT_EQUAL_HEX16(controlword, little_endian_read16(frame->data));
            TEST_ASSERT_EQUAL_INT(8, frame->data[2]);
        }
        TEST_ASSERT_EQUAL_UINT(1, controlwords);
    }
}

static void test_statuswords_lead_to_controlwords_one_drive_a_cycle(void)
{
    assert_controlword_in_turn(CIA402_SWITCH_ON_DISABLED, 0x0006);
    assert_controlword_in_turn(CIA402_READY, 0x0007);
    assert_controlword_in_turn(CIA402_SWITCHED_ON, 0x000F);
    assert_controlword_in_turn(CIA402_FAULT, 0x0080);
    TEST_ASSERT_EQUAL_INT(DRIVES_STARTING, drives_get_state(&drives));
}

static void test_a_drive_that_has_said_nothing_gets_no_controlword(void)
{
    for (unsigned i = 0; i < 6; i++) {
        put_status(2, CIA402_SWITCH_ON_DISABLED, 0);
        cycle();
        TEST_ASSERT_NULL(find_sent(0x201));
        TEST_ASSERT_NULL(find_sent(0x203));
    }
}

static void test_targets_are_the_actual_positions_until_a_drive_is_enabled(void)
{
    setpoint.at[AXIS_X] = setpoint.at[AXIS_Y] = setpoint.at[AXIS_Z] = 77;
    put_status(1, CIA402_READY, 1234);
    put_status(2, CIA402_SWITCHED_ON, -5);
    put_status(3, CIA402_ENABLED, 99);
    cycle();
    TEST_ASSERT_EQUAL_INT(1234, sent_target(0x301, 0));
    TEST_ASSERT_EQUAL_INT(-5, sent_target(0x301, 4));
    put_status(1, CIA402_READY, 1240);
    put_status(2, CIA402_SWITCHED_ON, -6);
    put_status(3, CIA402_SWITCHED_ON, 99);
    cycle();
    put_status(1, CIA402_READY, 1250);
    put_status(2, CIA402_ENABLED, -9);
    put_status(3, CIA402_ENABLED, 105);
    cycle();
    TEST_ASSERT_EQUAL_INT(1250, sent_target(0x301, 0));
    TEST_ASSERT_EQUAL_INT(-6, sent_target(0x301, 4));
    TEST_ASSERT_EQUAL_INT(99, sent_target(0x303, 0));
}

static void test_in_operation_a_cycle_is_sync_and_targets_alone(void)
{
    enable_at(0);
    follow(1);
    TEST_ASSERT_EQUAL_UINT(3, sent_count);
    TEST_ASSERT_EQUAL_HEX16(0x080, sent[0].id);
    TEST_ASSERT_EQUAL_HEX16(0x301, sent[1].id);
    TEST_ASSERT_EQUAL_INT(8, sent[1].length);
    TEST_ASSERT_EQUAL_HEX16(0x303, sent[2].id);
    TEST_ASSERT_EQUAL_INT(4, sent[2].length);
}

static void test_setpoints_are_rounded_half_away_from_zero(void)
{
    static const double at_mm[] = {0.0005, -0.0005, 0.00049, 1.2345, -1.2345, 0.0015};
    static const int32_t increments[] = {1, -1, 0, 1235, -1235, 2};
    for (unsigned i = 0; i < sizeof at_mm / sizeof at_mm[0]; i++) {
        setUp();
        enable_at((int32_t)lround(at_mm[i] * 1000));
        setpoint.at[AXIS_X] = setpoint.at[AXIS_Y] = setpoint.at[AXIS_Z] = at_mm[i];
        put_all(CIA402_ENABLED, (int32_t)lround(at_mm[i] * 1000));
        cycle();
        TEST_ASSERT_EQUAL_INT(increments[i], sent_target(0x301, 4));
    }
}

static void test_the_ends_of_the_position_range_are_reached_and_not_passed(void)
{
    struct drives_config config = three_axes();
    for (unsigned i = 0; i < 3; i++)
        config.axis[i].following_error_max_mm = 0;
    boot(&config);
    enable_at(0);
    setpoint.at[AXIS_X] = 2147483.647;
    setpoint.at[AXIS_Y] = -2147483.647;
    follow(1);
    TEST_ASSERT_EQUAL_INT(2147483647, sent_target(0x301, 0));
    TEST_ASSERT_EQUAL_INT(-2147483647, sent_target(0x301, 4));
    setpoint.at[AXIS_Z] = 2147483.648;
    put_all(CIA402_ENABLED, 0);
    cycle();
    assert_fault(TAKT_ERROR_DRIVE_RANGE, 'Z');
    TEST_ASSERT_NULL(find_sent(0x301));
}

static void test_a_setpoint_that_is_no_number_is_not_sent(void)
{
    enable_at(0);
    setpoint.at[AXIS_Y] = (double)NAN;
    put_all(CIA402_ENABLED, 0);
    cycle();
    assert_fault(TAKT_ERROR_DRIVE_RANGE, 'Y');
    TEST_ASSERT_NULL(find_sent(0x301));
}

static void test_drives_that_stand_anywhere_are_enabled_without_following_error(void)
{
    setpoint.at[AXIS_X] = setpoint.at[AXIS_Y] = setpoint.at[AXIS_Z] = 123.456;
    enable_at(123456);
    follow(10);
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
}

static void test_actual_positions_are_reported_by_axis(void)
{
    struct point actual;
    put_status(1, CIA402_READY, 1500);
    put_status(3, CIA402_READY, -250);
    cycle();
    drives_get_actual(&drives, &actual);
    TEST_ASSERT_TRUE(actual.at[AXIS_X] == 1.5);
    TEST_ASSERT_TRUE(actual.at[AXIS_Y] == 0);
    TEST_ASSERT_TRUE(actual.at[AXIS_Z] == -0.25);
    TEST_ASSERT_TRUE(actual.at[AXIS_C] == 0);
}

static void test_frames_of_strangers_are_passed_over(void)
{
    enable_at(0);
    for (unsigned id = 0; id < 0x800; id += 61) {
        struct can_frame frame = {.id = (uint16_t)(id & 0x780 ? id | 0x40 : id), .length = 8};
        *fake_nodes_add(&nodes) = frame;
    }
    put_all(CIA402_ENABLED, 0);
    cycle();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
}

static void test_frames_of_a_cycle_are_those_that_are_sent_and_answered(void)
{
    uint8_t length[DRIVES_CYCLE_FRAMES_MAX];
    static const uint8_t four[] = {0, 8, 8, 6, 6, 6, 6, 6, 1}, three[] = {0, 8, 4, 6, 6, 6, 6, 1};
    TEST_ASSERT_EQUAL_UINT(9, takt_drives_cycle_frames(4, TARGET_PDO_PAIR, true, length));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(four, length, 9);
    TEST_ASSERT_EQUAL_UINT(8, takt_drives_cycle_frames(3, TARGET_PDO_PAIR, true, length));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(three, length, 8);
    TEST_ASSERT_TRUE(takt_drives_cycle_frames(AXIS_COUNT, TARGET_PDO_PAIR, true, length) <=
                     DRIVES_CYCLE_FRAMES_MAX);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_statuswords_lead_to_controlwords_one_drive_a_cycle);
    RUN_TEST(test_a_drive_that_has_said_nothing_gets_no_controlword);
    RUN_TEST(test_targets_are_the_actual_positions_until_a_drive_is_enabled);
    RUN_TEST(test_in_operation_a_cycle_is_sync_and_targets_alone);
    RUN_TEST(test_setpoints_are_rounded_half_away_from_zero);
    RUN_TEST(test_the_ends_of_the_position_range_are_reached_and_not_passed);
    RUN_TEST(test_a_setpoint_that_is_no_number_is_not_sent);
    RUN_TEST(test_drives_that_stand_anywhere_are_enabled_without_following_error);
    RUN_TEST(test_actual_positions_are_reported_by_axis);
    RUN_TEST(test_frames_of_strangers_are_passed_over);
    RUN_TEST(test_frames_of_a_cycle_are_those_that_are_sent_and_answered);
    return UNITY_END();
}
