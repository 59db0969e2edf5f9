/*
 * What the master makes of everything that can go wrong. How the drives are stopped then:
 * test_drive_stopping.c.
 */
#include "lone_master.h"

static void test_a_drive_in_fault_stops_all_drives_and_names_its_emergency(void)
{
    struct emcy emcy = {.node = 2, .code = 0x8611};
    enable_at(0);
    takt_emcy_write(fake_nodes_add(&nodes), &emcy);
    put_status(1, CIA402_ENABLED, 0);
    put_status(2, CIA402_FAULT_REACTION, 0);
    put_status(3, CIA402_ENABLED, 0);
    cycle();
    assert_fault(TAKT_ERROR_DRIVE_FAULT, 'Y');
    TEST_ASSERT_TRUE(takt_drives_get_fault(&drives)->value == 0x8611);
    for (unsigned node = 1; node <= 3; node++) {
        const struct can_frame *frame = get_sent(0x200 + node);
        TEST_ASSERT_EQUAL_HEX16(0x0002, little_endian_read16(frame->data));
    }
    TEST_ASSERT_NULL(find_sent(0x301));
}

static void test_an_emergency_that_comes_after_the_statusword_completes_the_diagnostic(void)
{
    struct emcy emcy = {.node = 3, .code = 0x4310};
    enable_at(0);
    put_status(3, CIA402_FAULT, 0);
    cycle();
    TEST_ASSERT_TRUE(takt_drives_get_fault(&drives)->value == 0);
    takt_emcy_write(fake_nodes_add(&nodes), &emcy);
    cycle();
    assert_fault(TAKT_ERROR_DRIVE_FAULT, 'Z');
    TEST_ASSERT_TRUE(takt_drives_get_fault(&drives)->value == 0x4310);
}

static void test_a_drive_that_leaves_operation_is_a_fault_that_names_its_state(void)
{
    enable_at(0);
    put_all(CIA402_ENABLED, 0);
    put_status(1, CIA402_SWITCHED_ON, 0);
    cycle();
    assert_fault(TAKT_ERROR_DRIVE_STATE, 'X');
    TEST_ASSERT_EQUAL_STRING("switched on", takt_drives_get_fault(&drives)->meaning);
}

static void put_heartbeat(uint8_t node, enum nmt_state state)
{
    put_all(CIA402_ENABLED, 0);
    takt_nmt_write_heartbeat(fake_nodes_add(&nodes), node, state);
    cycle();
}

static void test_a_drive_that_boots_or_is_not_operational_is_a_fault(void)
{
    enable_at(0);
    put_heartbeat(2, NMT_OPERATIONAL);
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    put_heartbeat(2, NMT_BOOTED);
    assert_fault(TAKT_ERROR_DRIVE_REBOOTED, 'Y');
    setUp();
    enable_at(0);
    put_heartbeat(3, NMT_STOPPED);
    assert_fault(TAKT_ERROR_DRIVE_NMT, 'Z');
}

static void test_an_emergency_of_a_drive_that_goes_on_is_a_fault(void)
{
    struct emcy emcy = {.node = 3, .code = 0x8210};
    enable_at(0);
    takt_emcy_write(fake_nodes_add(&nodes), &emcy);
    put_all(CIA402_ENABLED, 0);
    cycle();
    assert_fault(TAKT_ERROR_DRIVE_FAULT, 'Z');
    TEST_ASSERT_EQUAL_STRING("PDO too short", takt_drives_get_fault(&drives)->meaning);
}

static void test_an_error_code_in_tpdo2_completes_the_diagnostic_too(void)
{
    enable_at(0);
    put_status(3, CIA402_FAULT, 0);
    cycle();
    struct can_frame *frame = fake_nodes_add(&nodes);
    *frame = (struct can_frame){.id = 0x283, .length = 6, .data = {0x05, 0x73}};
    cycle();
    TEST_ASSERT_TRUE(takt_drives_get_fault(&drives)->value == 0x7305);
}

static void test_a_fault_is_told_with_axis_node_code_and_meaning(void)
{
    char text[DIAGNOSTIC_TEXT_MAX];
    struct emcy emcy = {.node = 2, .code = 0x8611};
    enable_at(0);
    takt_emcy_write(fake_nodes_add(&nodes), &emcy);
    put_all(CIA402_ENABLED, 0);
    cycle();
    (void)takt_diagnostic_text(takt_drives_get_fault(&drives), text);
    TEST_ASSERT_EQUAL_STRING("the drive of axis Y (node 2) reports 8611: following error", text);
}

static void run_heartbeats(unsigned beating_ms, unsigned cycles)
{
    struct drives_config config = three_axes();
    config.heartbeat_ms = 10;
    boot(&config);
    enable_at(0);
    for (unsigned k = 0; k < cycles && drives_get_state(&drives) == DRIVES_ENABLED; k++) {
        put_all(CIA402_ENABLED, 0);
        for (unsigned node = 1; node <= 3 && k % 10 == 0; node++)
            if (node != 2 || k < beating_ms)
                takt_nmt_write_heartbeat(fake_nodes_add(&nodes), (uint8_t)node, NMT_OPERATIONAL);
        cycle();
    }
}

static void test_three_missed_heartbeats_are_a_fault(void)
{
    run_heartbeats(1000, 200);
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    run_heartbeats(100, 200);
    assert_fault(TAKT_ERROR_DRIVE_HEARTBEAT, 'Y');
    TEST_ASSERT_TRUE(takt_drives_get_fault(&drives)->value == 31);
}

static void test_the_controller_sends_heartbeats_of_its_own(void)
{
    struct drives_config config = three_axes();
    unsigned heartbeats = 0;
    config.heartbeat_ms = 10;
    boot(&config);
    for (unsigned k = 0; k < 100; k++) {
        cycle();
        heartbeats += find_sent(0x77F) != NULL;
    }
    TEST_ASSERT_EQUAL_UINT(10, heartbeats);
}

static void test_the_first_fault_is_the_one_that_is_kept(void)
{
    enable_at(0);
    put_status(2, CIA402_FAULT, 0);
    cycle();
    put_status(1, CIA402_FAULT, 0);
    cycle();
    assert_fault(TAKT_ERROR_DRIVE_FAULT, 'Y');
}

static void test_a_silent_drive_is_found_after_the_timeout_and_not_before(void)
{
    enable_at(0);
    for (unsigned i = 0; i < 2; i++) {
        put_status(1, CIA402_ENABLED, 0);
        put_status(3, CIA402_ENABLED, 0);
        cycle();
        TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    }
    put_status(1, CIA402_ENABLED, 0);
    put_status(3, CIA402_ENABLED, 0);
    cycle();
    assert_fault(TAKT_ERROR_DRIVE_SILENT, 'Y');
}

static void test_a_status_frame_that_is_too_short_is_no_answer(void)
{
    enable_at(0);
    for (unsigned i = 0; i < 3; i++) {
        put_all(CIA402_ENABLED, 0);
        nodes.pending[nodes.pending_read % FAKE_NODES_PENDING].length = 5;
        cycle();
    }
    assert_fault(TAKT_ERROR_DRIVE_SILENT, 'X');
}

static bool is_starting(void)
{
    return drives_get_state(&drives) == DRIVES_STARTING && cycles_run < 2 * START_CYCLES;
}

static void test_drives_that_do_not_get_enabled_in_time_fail_the_start(void)
{
    while (is_starting()) {
        put_status(1, CIA402_ENABLED, 0);
        put_status(3, CIA402_ENABLED, 0);
        cycle();
    }
    TEST_ASSERT_TRUE(cycles_run > START_CYCLES);
    assert_fault(TAKT_ERROR_DRIVE_SILENT, 'Y');
    setUp();
    while (is_starting()) {
        put_all(CIA402_ENABLED, 0);
        put_status(3, CIA402_FAULT, 0);
        cycle();
    }
    assert_fault(TAKT_ERROR_DRIVE_FAULT, 'Z');
    setUp();
    while (is_starting()) {
        put_all(CIA402_ENABLED, 0);
        put_status(3, CIA402_READY, 0);
        cycle();
    }
    assert_fault(TAKT_ERROR_DRIVE_NOT_ENABLED, 'Z');
}

static void test_following_error_is_counted_from_the_setpoint_that_belongs_to_the_report(void)
{
    struct drives_config config = three_axes();
    for (unsigned i = 0; i < 3; i++)
        config.axis[i].following_error_max_mm = 0.05;
    boot(&config);
    run_delayed(DRIVES_LATENCY_CYCLES, 100);
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    boot(&config);
    run_delayed(DRIVES_LATENCY_CYCLES + 1, 100);
    assert_fault(TAKT_ERROR_DRIVE_FOLLOWING, 'X');
    boot(&config);
    run_delayed(DRIVES_LATENCY_CYCLES - 1, 100);
    assert_fault(TAKT_ERROR_DRIVE_FOLLOWING, 'X');
}

static void test_a_lagging_axis_is_named_with_its_lag(void)
{
    enable_at(0);
    for (unsigned i = 0; i < 8; i++) {
        put_all(CIA402_ENABLED, 0);
        put_status(2, CIA402_ENABLED, 501);
        cycle();
    }
    assert_fault(TAKT_ERROR_DRIVE_FOLLOWING, 'Y');
    TEST_ASSERT_TRUE(fabs(takt_drives_get_fault(&drives)->value - 0.501) < 1e-12);
}

static void test_a_setpoint_that_the_bus_refuses_is_a_fault(void)
{
    enable_at(0);
    refused_id = 0x303;
    put_all(CIA402_ENABLED, 0);
    cycle();
    assert_fault(TAKT_ERROR_DRIVE_UNREACHABLE, 'Z');
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_drive_in_fault_stops_all_drives_and_names_its_emergency);
    RUN_TEST(test_an_emergency_that_comes_after_the_statusword_completes_the_diagnostic);
    RUN_TEST(test_a_drive_that_leaves_operation_is_a_fault_that_names_its_state);
    RUN_TEST(test_a_drive_that_boots_or_is_not_operational_is_a_fault);
    RUN_TEST(test_an_emergency_of_a_drive_that_goes_on_is_a_fault);
    RUN_TEST(test_an_error_code_in_tpdo2_completes_the_diagnostic_too);
    RUN_TEST(test_a_fault_is_told_with_axis_node_code_and_meaning);
    RUN_TEST(test_three_missed_heartbeats_are_a_fault);
    RUN_TEST(test_the_controller_sends_heartbeats_of_its_own);
    RUN_TEST(test_the_first_fault_is_the_one_that_is_kept);
    RUN_TEST(test_a_silent_drive_is_found_after_the_timeout_and_not_before);
    RUN_TEST(test_a_status_frame_that_is_too_short_is_no_answer);
    RUN_TEST(test_drives_that_do_not_get_enabled_in_time_fail_the_start);
    RUN_TEST(test_following_error_is_counted_from_the_setpoint_that_belongs_to_the_report);
    RUN_TEST(test_a_lagging_axis_is_named_with_its_lag);
    RUN_TEST(test_a_setpoint_that_the_bus_refuses_is_a_fault);
    return UNITY_END();
}
