/*
 * Homing by the master: in which order, what the drives are told, and what can go wrong.
 */
#include "starting_master.h"

static void home_axes(uint8_t order_x, uint8_t order_y, uint8_t order_z)
{
    const uint8_t order[] = {order_x, order_y, order_z};
    for (unsigned i = 0; i < DRIVES; i++)
        config.axis[i].homing = (struct drives_homing){.order = order[i],
                                                       .method = 17,
                                                       .velocity_mm_s = 20,
                                                       .zero_mm_s = 2,
                                                       .acceleration_mm_s2 = 500,
                                                       .offset_mm = -1.5,
                                                       .timeout_cycles = 300};
}

static bool is_homing(unsigned node)
{
    return (control[node] & 0x1F) == 0x1F && nodes.mode[node] == 6;
}

static void run_until_homing(unsigned node)
{
    for (unsigned i = 0; i < 400 && !is_homing(node); i++)
        cycle();
    TEST_ASSERT_TRUE(is_homing(node));
}

static void test_homing_is_configured_only_where_it_is_wanted(void)
{
    home_axes(0, 1, 0);
    takt_drives_init(&drives, &config);
    run_until_homing(2);
    assert_told(2, SDO_OBJECT(0x6098, 0), 17);
    assert_told(2, SDO_OBJECT(0x6099, 1), 20000);
    assert_told(2, SDO_OBJECT(0x6099, 2), 2000);
    assert_told(2, SDO_OBJECT(0x609A, 0), 500000);
    assert_told(2, SDO_OBJECT(0x607C, 0), 1500);
    TEST_ASSERT_NULL(fake_nodes_told(&nodes, 1, SDO_OBJECT(0x6098, 0)));
}

static void test_axes_are_homed_in_their_order_and_those_of_one_order_together(void)
{
    home_axes(2, 2, 1);
    takt_drives_init(&drives, &config);
    run_until_homing(3);
    for (unsigned i = 0; i < 50; i++) {
        cycle();
        TEST_ASSERT_FALSE(is_homing(1));
        TEST_ASSERT_FALSE(is_homing(2));
    }
    shown_bits[3] = 0x1400;
    run_until_homing(1);
    run_until_homing(2);
    TEST_ASSERT_FALSE(is_homing(3));
    TEST_ASSERT_EQUAL_UINT(8, nodes.mode[3]);
    shown_bits[1] = 0x1400;
    for (unsigned i = 0; i < 50; i++)
        cycle();
    TEST_ASSERT_EQUAL_INT(DRIVES_STARTING, drives_get_state(&drives));
    shown_bits[2] = 0x1400;
    run_until(DRIVES_ENABLED);
    for (unsigned node = 1; node <= DRIVES; node++)
        TEST_ASSERT_EQUAL_UINT(8, nodes.mode[node]);
}

static void test_an_attained_bit_from_before_does_not_count_while_the_drive_may_still_answer(void)
{
    home_axes(1, 0, 0);
    shown_bits[1] = 0x1400;
    takt_drives_init(&drives, &config);
    run_until_homing(1);
    for (unsigned i = 0; i < 80; i++)
        cycle();
    shown_bits[1] = 0;
    for (unsigned i = 0; i < 100; i++)
        cycle();
    TEST_ASSERT_EQUAL_INT(DRIVES_STARTING, drives_get_state(&drives));
    shown_bits[1] = 0x1400;
    run_until(DRIVES_ENABLED);
}

static void test_a_drive_that_has_been_homed_is_told_to_stay_where_it_now_is(void)
{
    home_axes(0, 0, 1);
    takt_drives_init(&drives, &config);
    run_until_homing(3);
    shown_bits[3] = 0x1400;
    shown_inc = -1500;
    while (nodes.mode[3] != 8 && cycles_run < START_CYCLES)
        cycle();
    TEST_ASSERT_EQUAL_INT(DRIVES_STARTING, drives_get_state(&drives));
    TEST_ASSERT_EQUAL_INT32(-1500, target_of_3);
}

static void test_a_position_that_follows_its_statusword_later_makes_no_axis_jump(void)
{
    home_axes(0, 0, 1);
    takt_drives_init(&drives, &config);
    run_until_homing(3);
    shown_bits[3] = 0x1400;
    for (unsigned i = 0; i < 50; i++)
        cycle();
    shown_inc = -1500;
    while (nodes.mode[3] != 8 && cycles_run < START_CYCLES)
        cycle();
    TEST_ASSERT_EQUAL_UINT(8, nodes.mode[3]);
    TEST_ASSERT_EQUAL_INT32(-1500, target_of_3);
}

static void test_a_motor_that_swings_about_its_home_is_homed(void)
{
    home_axes(0, 0, 1);
    takt_drives_init(&drives, &config);
    run_until_homing(3);
    for (unsigned i = 0; i < 220; i++) {
        shown_bits[3] = i % 20 < 10 ? 0x1400 : 0x1000;
        cycle();
    }
    TEST_ASSERT_EQUAL_UINT(8, nodes.mode[3]);
}

static void test_a_drive_that_takes_the_home_offset_for_its_position_is_told_that(void)
{
    home_axes(0, 0, 1);
    config.axis[2].homing.offset_is_position = true;
    takt_drives_init(&drives, &config);
    run_until_homing(3);
    assert_told(3, SDO_OBJECT(0x607C, 0), (uint32_t)-1500);
    shown_inc = -1500;
    shown_bits[3] = 0x1400;
    run_until(DRIVES_ENABLED);
}

static void test_a_home_with_the_other_sign_is_a_fault_that_says_so(void)
{
    home_axes(0, 0, 1);
    takt_drives_init(&drives, &config);
    run_until_homing(3);
    shown_inc = 1500 + 400; /* 0.4 mm: from 20 mm/s at 500 mm/s2 */
    shown_bits[3] = 0x1400;
    run_until(DRIVES_BRAKING);
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_DRIVE_HOME_OFFSET, takt_drives_get_fault(&drives)->code);
    assert_text(
        "after homing axis Z (node 3) is at 1.9 mm: change home_offset_is_position for this drive");
}

static void test_a_home_near_zero_has_no_sign(void)
{
    home_axes(0, 0, 1);
    config.axis[2].homing.offset_mm = 0.1;
    takt_drives_init(&drives, &config);
    run_until_homing(3);
    shown_inc = -100;
    shown_bits[3] = 0x1400;
    run_until(DRIVES_ENABLED);
}

static void test_a_homing_error_is_told_with_the_statusword(void)
{
    home_axes(1, 0, 0);
    takt_drives_init(&drives, &config);
    run_until_homing(1);
    shown_bits[1] = 0x2000;
    run_until(DRIVES_BRAKING);
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_DRIVE_HOMING, takt_drives_get_fault(&drives)->code);
    assert_text("the drive of axis X (node 1) reports an error while homing: statusword 2027");
}

static void test_homing_that_does_not_end_is_given_up(void)
{
    home_axes(0, 0, 1);
    takt_drives_init(&drives, &config);
    run_until_homing(3);
    run_until(DRIVES_BRAKING);
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_DRIVE_HOMING_SLOW, takt_drives_get_fault(&drives)->code);
    assert_text("homing of axis Z (node 3) has not ended within 0.3 s");
}

static void test_a_fault_while_homing_stops_all_axes(void)
{
    home_axes(1, 1, 1);
    takt_drives_init(&drives, &config);
    run_until_homing(1);
    run_until_homing(2);
    run_until_homing(3);
    shown[2] = CIA402_FAULT;
    cycle();
    TEST_ASSERT_EQUAL_INT(DRIVES_BRAKING, drives_get_state(&drives));
    for (unsigned node = 1; node <= DRIVES; node++)
        TEST_ASSERT_EQUAL_HEX16(0x0002, control[node]);
    assert_text("the drive of axis Y (node 2) reports 0000: a fault without a code");
}

static void test_axes_that_are_homed_already_are_not_homed_again(void)
{
    home_axes(1, 1, 1);
    config.homed = true;
    run_start();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    TEST_ASSERT_TRUE(takt_drives_are_homed(&drives));
}

static void run_homed(void)
{
    home_axes(1, 1, 1);
    config.homed = true;
    run_start();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
}

static void test_a_drive_that_has_restarted_by_itself_has_lost_its_home(void)
{
    run_homed();
    takt_nmt_write_heartbeat(fake_nodes_add(&nodes), 2, NMT_BOOTED);
    cycle();
    TEST_ASSERT_FALSE(takt_drives_are_homed(&drives));
}

static void test_a_drive_that_restarts_while_its_alarm_stands_has_lost_its_home(void)
{
    run_homed();
    takt_drives_stop_at_once(&drives, TAKT_ERROR_ENDED);
    run_until(DRIVES_FAULTED);
    TEST_ASSERT_TRUE(takt_drives_are_homed(&drives));
    takt_nmt_write_heartbeat(fake_nodes_add(&nodes), 2, NMT_BOOTED);
    cycle();
    TEST_ASSERT_FALSE(takt_drives_are_homed(&drives));
}

static void test_a_drive_that_is_not_heard_any_more_may_have_lost_its_home(void)
{
    run_homed();
    nodes.mute = 3;
    run_until(DRIVES_FAULTED);
    for (unsigned i = 0; i < 400; i++)
        cycle();
    TEST_ASSERT_FALSE(takt_drives_are_homed(&drives));
}

static void test_so_may_one_without_heartbeats(void)
{
    config.heartbeat_ms = 0;
    run_homed();
    takt_drives_stop_at_once(&drives, TAKT_ERROR_ENDED);
    run_until(DRIVES_FAULTED);
    for (unsigned i = 0; i < 400; i++)
        cycle();
    TEST_ASSERT_TRUE(takt_drives_are_homed(&drives));
    nodes.mute = 3;
    for (unsigned i = 0; i < 400; i++)
        cycle();
    TEST_ASSERT_FALSE(takt_drives_are_homed(&drives));
}

static void test_a_drive_that_does_not_answer_any_more_may_have_lost_its_home(void)
{
    home_axes(1, 1, 1);
    config.homed = true;
    nodes.mute = 3;
    takt_drives_init(&drives, &config);
    run_until(DRIVES_FAULTED);
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_DRIVE_ABSENT, takt_drives_get_fault(&drives)->code);
    TEST_ASSERT_FALSE(takt_drives_are_homed(&drives));
}

static void test_a_start_that_is_broken_off_loses_no_home(void)
{
    home_axes(1, 1, 1);
    config.homed = true;
    nodes.wordless = 2;
    takt_drives_init(&drives, &config);
    for (unsigned i = 0; i < 20; i++)
        cycle();
    takt_drives_stop_at_once(&drives, TAKT_ERROR_ENDED);
    takt_nmt_write_heartbeat(fake_nodes_add(&nodes), 2, NMT_BOOTED);
    nodes.mute = 3;
    for (unsigned i = 0; i < 400; i++)
        cycle();
    TEST_ASSERT_EQUAL_INT(DRIVES_FAULTED, drives_get_state(&drives));
    TEST_ASSERT_TRUE(takt_drives_are_homed(&drives));
}

static void test_drives_that_are_heard_all_along_keep_their_homes(void)
{
    run_homed();
    shown[2] = CIA402_FAULT;
    run_until(DRIVES_FAULTED);
    for (unsigned i = 0; i < 400; i++)
        cycle();
    TEST_ASSERT_TRUE(takt_drives_are_homed(&drives));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_homing_is_configured_only_where_it_is_wanted);
    RUN_TEST(test_axes_are_homed_in_their_order_and_those_of_one_order_together);
    RUN_TEST(test_an_attained_bit_from_before_does_not_count_while_the_drive_may_still_answer);
    RUN_TEST(test_a_drive_that_has_been_homed_is_told_to_stay_where_it_now_is);
    RUN_TEST(test_a_position_that_follows_its_statusword_later_makes_no_axis_jump);
    RUN_TEST(test_a_motor_that_swings_about_its_home_is_homed);
    RUN_TEST(test_a_drive_that_takes_the_home_offset_for_its_position_is_told_that);
    RUN_TEST(test_a_home_with_the_other_sign_is_a_fault_that_says_so);
    RUN_TEST(test_a_home_near_zero_has_no_sign);
    RUN_TEST(test_a_homing_error_is_told_with_the_statusword);
    RUN_TEST(test_homing_that_does_not_end_is_given_up);
    RUN_TEST(test_a_fault_while_homing_stops_all_axes);
    RUN_TEST(test_axes_that_are_homed_already_are_not_homed_again);
    RUN_TEST(test_a_drive_that_has_restarted_by_itself_has_lost_its_home);
    RUN_TEST(test_a_drive_that_restarts_while_its_alarm_stands_has_lost_its_home);
    RUN_TEST(test_a_drive_that_is_not_heard_any_more_may_have_lost_its_home);
    RUN_TEST(test_so_may_one_without_heartbeats);
    RUN_TEST(test_a_drive_that_does_not_answer_any_more_may_have_lost_its_home);
    RUN_TEST(test_a_start_that_is_broken_off_loses_no_home);
    RUN_TEST(test_drives_that_are_heard_all_along_keep_their_homes);
    return UNITY_END();
}
