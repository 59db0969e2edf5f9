/*
 * How the master stops the drives after a fault: with setpoints to rest where there is time, by
 * themselves where there is not.
 */
#include "lone_master.h"

static void test_a_quick_stop_that_the_bus_refuses_is_sent_again(void)
{
    enable_at(0);
    put_all(CIA402_FAULT, 0);
    refused_id = 0x202;
    cycle();
    TEST_ASSERT_NOT_NULL(find_sent(0x201));
    refused_id = 0xFFFF;
    cycle();
    TEST_ASSERT_NOT_NULL(find_sent(0x202));
}

static unsigned quick_stops(unsigned node, enum cia402_state state)
{
    unsigned count = 0;
    for (unsigned i = 0; i < 30; i++) {
        put_all(state, 0);
        cycle();
        const struct can_frame *frame = find_sent(0x200 + node);
        count += frame != NULL && frame->data[0] == CIA402_QUICK_STOP_NOW;
    }
    return count;
}

static void test_a_quick_stop_is_sent_again_until_the_statusword_shows_it(void)
{
    enable_at(0);
    put_status(3, CIA402_FAULT, 0);
    cycle();
    TEST_ASSERT_TRUE(quick_stops(1, CIA402_ENABLED) >= 9);
    TEST_ASSERT_EQUAL_UINT(0, quick_stops(1, CIA402_QUICK_STOP));
}

static unsigned switched_off(unsigned cycles)
{
    unsigned count = 0;
    for (unsigned i = 0; i < cycles; i++) {
        put_all(CIA402_QUICK_STOP, 0);
        cycle();
        const struct can_frame *frame = find_sent(0x201);
        count += frame != NULL && frame->data[0] == CIA402_DISABLE_VOLTAGE;
    }
    return count;
}

/* 605A: 5 ... 8 keep the torque. It has all of its time to brake, for its position may be stuck. */
static void test_a_drive_that_stays_in_quick_stop_is_switched_off_after_its_time(void)
{
    enable_at(0);
    put_status(3, CIA402_FAULT, 0);
    cycle();
    TEST_ASSERT_EQUAL_UINT(0, switched_off(100));
    TEST_ASSERT_EQUAL_INT(DRIVES_BRAKING, drives_get_state(&drives));
    TEST_ASSERT_TRUE(switched_off(20) >= 2); /* one may get lost */
    TEST_ASSERT_EQUAL_INT(DRIVES_FAULTED, drives_get_state(&drives));
}

static void test_the_drives_count_as_faulted_when_all_are_switched_off_and_stand(void)
{
    enable_at(0);
    put_status(2, CIA402_FAULT, 0);
    cycle();
    for (int32_t i = 0; i < 50; i++) {
        put_all(CIA402_QUICK_STOP, 10 * i);
        cycle();
        TEST_ASSERT_EQUAL_INT(DRIVES_BRAKING, drives_get_state(&drives));
    }
    for (int32_t i = 0; i < 10; i++) {
        TEST_ASSERT_EQUAL_INT(DRIVES_BRAKING, drives_get_state(&drives));
        put_all(CIA402_SWITCH_ON_DISABLED, 490);
        cycle();
    }
    TEST_ASSERT_EQUAL_INT(DRIVES_FAULTED, drives_get_state(&drives));
}

/* The state of the master when all drives have stood for long, Y in this state. */
static enum drives_state state_beside(enum cia402_state state)
{
    setUp();
    enable_at(0);
    put_status(2, CIA402_FAULT, 0);
    for (unsigned i = 0; i < 50; i++) {
        cycle();
        put_all(CIA402_SWITCH_ON_DISABLED, 0);
        put_status(2, state, 0);
    }
    return drives_get_state(&drives);
}

static void test_a_drive_that_stands_is_not_switched_off_while_its_state_has_torque(void)
{
    for (int state = CIA402_NOT_READY; state <= CIA402_FAULT; state++) {
        const bool has_torque =
            state == CIA402_ENABLED || state == CIA402_QUICK_STOP || state == CIA402_FAULT_REACTION;

        TEST_ASSERT_EQUAL_INT_MESSAGE(has_torque ? DRIVES_BRAKING : DRIVES_FAULTED,
                                      state_beside((enum cia402_state)state),
                                      takt_cia402_state_text((enum cia402_state)state));
    }
}

static void test_a_drive_that_never_stands_is_given_up_after_the_timeout(void)
{
    enable_at(0);
    put_status(2, CIA402_FAULT, 0);
    cycle();
    for (unsigned i = 0; i < 100; i++) {
        cycle();
        TEST_ASSERT_EQUAL_INT(DRIVES_BRAKING, drives_get_state(&drives));
    }
    cycle();
    TEST_ASSERT_EQUAL_INT(DRIVES_FAULTED, drives_get_state(&drives));
}

/* Three axes that do not watch how far each stays behind, and time for the caller to stop. */
static struct drives_config time_to_stop(void)
{
    struct drives_config config = three_axes();
    config.stop_timeout_cycles = 40;
    for (unsigned i = 0; i < 3; i++)
        config.axis[i].following_error_max_mm = 0;
    return config;
}

/* A fault of Y, from a run at 0.1 mm a cycle. */
static void fault_with_time_to_stop(void)
{
    struct drives_config config = time_to_stop();
    boot(&config);
    run_delayed(DRIVES_LATENCY_CYCLES, 50);
    put_all(CIA402_ENABLED, (int32_t)lround(1000 * setpoint.at[AXIS_X]) - 200);
    put_status(2, CIA402_FAULT, 0);
    cycle();
}

/* X goes on by so much, and all report where it is; Y is in fault. */
static void cycle_beside_fault(double way_mm)
{
    setpoint.at[AXIS_X] += way_mm;
    put_all(CIA402_ENABLED, (int32_t)lround(1000 * setpoint.at[AXIS_X]));
    put_status(2, CIA402_FAULT, 0);
    cycle();
}

static void test_setpoints_are_followed_to_rest_after_a_fault_where_there_is_time(void)
{
    fault_with_time_to_stop();
    for (unsigned i = 0; i < 20; i++) {
        cycle_beside_fault(0.01);
        TEST_ASSERT_EQUAL_INT(DRIVES_STOPPING, drives_get_state(&drives));
        TEST_ASSERT_EQUAL_INT((int32_t)lround(1000 * setpoint.at[AXIS_X]), sent_target(0x301, 0));
    }
    for (unsigned i = 0; i < DRIVES_LATENCY_CYCLES; i++)
        cycle_beside_fault(0);
    assert_fault(TAKT_ERROR_DRIVE_FAULT, 'Y');
    TEST_ASSERT_EQUAL_HEX16(0x0002, little_endian_read16(get_sent(0x201)->data));
}

static void test_setpoints_that_do_not_come_to_rest_in_time_are_cut_off(void)
{
    fault_with_time_to_stop();
    for (unsigned i = 0; i < 40; i++) {
        TEST_ASSERT_EQUAL_INT(DRIVES_STOPPING, drives_get_state(&drives));
        cycle_beside_fault(0.01);
    }
    assert_fault(TAKT_ERROR_DRIVE_FAULT, 'Y');
}

static void test_all_brake_when_the_path_asks_the_faulty_drive_to_move(void)
{
    fault_with_time_to_stop();
    cycle_beside_fault(0.01);
    TEST_ASSERT_EQUAL_INT(DRIVES_STOPPING, drives_get_state(&drives));
    setpoint.at[AXIS_Y] += 0.01;
    cycle_beside_fault(0.01);
    assert_fault(TAKT_ERROR_DRIVE_FAULT, 'Y');
}

static void test_a_drive_that_only_warns_follows_to_rest(void)
{
    struct emcy emcy = {.node = 2, .code = 0x8210};
    struct drives_config config = time_to_stop();
    boot(&config);
    run_delayed(DRIVES_LATENCY_CYCLES, 50);
    takt_emcy_write(fake_nodes_add(&nodes), &emcy);
    for (unsigned i = 0; i < 20; i++) {
        setpoint.at[AXIS_X] = setpoint.at[AXIS_Y] += 0.01;
        put_all(CIA402_ENABLED, (int32_t)lround(1000 * setpoint.at[AXIS_X]));
        cycle();
        TEST_ASSERT_EQUAL_INT(DRIVES_STOPPING, drives_get_state(&drives));
    }
}

static void test_a_warning_from_a_drive_that_falls_silent_is_a_loss(void)
{
    struct emcy emcy = {.node = 2, .code = 0x8210};
    struct drives_config config = time_to_stop();
    boot(&config);
    run_delayed(DRIVES_LATENCY_CYCLES, 50);
    takt_emcy_write(fake_nodes_add(&nodes), &emcy);
    for (unsigned i = 0; i <= DRIVES_LATENCY_CYCLES; i++) {
        setpoint.at[AXIS_Y] += 0.01;
        cycle();
    }
    assert_fault(TAKT_ERROR_DRIVE_FAULT, 'Y');
}

/*
 * Y stands behind its setpoint by before_inc, warns, and is behind by after_inc while the path goes
 * on.
 */
static enum drives_state state_after_warning_and_lag(int32_t before_inc, int32_t after_inc)
{
    struct emcy emcy = {.node = 2, .code = 0x8210};
    struct drives_config config = time_to_stop();
    config.axis[1].following_error_max_mm = 1;
    boot(&config);
    enable_at(0);
    for (unsigned i = 0; i < 8; i++) {
        put_all(CIA402_ENABLED, 0);
        put_status(2, CIA402_ENABLED, -before_inc);
        cycle();
    }
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    takt_emcy_write(fake_nodes_add(&nodes), &emcy);
    setpoint.at[AXIS_Y] = 1e-6; /* the path goes on */
    for (unsigned i = 0; i < 2; i++) {
        put_all(CIA402_ENABLED, 0);
        put_status(2, CIA402_ENABLED, -after_inc);
        cycle();
        setpoint.at[AXIS_Y] += 1e-6;
    }
    return drives_get_state(&drives);
}

static void test_a_warning_from_a_drive_that_stays_behind_is_a_loss(void)
{
    TEST_ASSERT_EQUAL_INT(DRIVES_STOPPING, state_after_warning_and_lag(300, 390));
    TEST_ASSERT_EQUAL_INT(DRIVES_BRAKING, state_after_warning_and_lag(300, 410));
    TEST_ASSERT_EQUAL_INT(DRIVES_STOPPING, state_after_warning_and_lag(300, 0));
    TEST_ASSERT_EQUAL_INT(DRIVES_BRAKING, state_after_warning_and_lag(950, 1010));
}

static void test_a_refused_setpoint_ends_the_stop_on_the_path(void)
{
    fault_with_time_to_stop();
    TEST_ASSERT_EQUAL_INT(DRIVES_STOPPING, drives_get_state(&drives));
    refused_id = 0x303;
    setpoint.at[AXIS_X] += 0.01;
    cycle();
    assert_fault(TAKT_ERROR_DRIVE_FAULT, 'Y');
}

static void test_all_drives_brake_when_asked_to_stop_at_once(void)
{
    enable_at(0);
    takt_drives_stop_at_once(&drives, TAKT_ERROR_EMERGENCY_STOP);
    cycle();
    TEST_ASSERT_EQUAL_INT(DRIVES_BRAKING, drives_get_state(&drives));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_EMERGENCY_STOP, takt_drives_get_fault(&drives)->code);
    for (unsigned node = 1; node <= 3; node++)
        TEST_ASSERT_EQUAL_HEX16(0x0002, little_endian_read16(get_sent(0x200 + node)->data));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_quick_stop_that_the_bus_refuses_is_sent_again);
    RUN_TEST(test_a_quick_stop_is_sent_again_until_the_statusword_shows_it);
    RUN_TEST(test_a_drive_that_stays_in_quick_stop_is_switched_off_after_its_time);
    RUN_TEST(test_the_drives_count_as_faulted_when_all_are_switched_off_and_stand);
    RUN_TEST(test_a_drive_that_stands_is_not_switched_off_while_its_state_has_torque);
    RUN_TEST(test_a_drive_that_never_stands_is_given_up_after_the_timeout);
    RUN_TEST(test_setpoints_are_followed_to_rest_after_a_fault_where_there_is_time);
    RUN_TEST(test_setpoints_that_do_not_come_to_rest_in_time_are_cut_off);
    RUN_TEST(test_all_brake_when_the_path_asks_the_faulty_drive_to_move);
    RUN_TEST(test_a_drive_that_only_warns_follows_to_rest);
    RUN_TEST(test_a_warning_from_a_drive_that_falls_silent_is_a_loss);
    RUN_TEST(test_a_warning_from_a_drive_that_stays_behind_is_a_loss);
    RUN_TEST(test_a_refused_setpoint_ends_the_stop_on_the_path);
    RUN_TEST(test_all_drives_brake_when_asked_to_stop_at_once);
    return UNITY_END();
}
