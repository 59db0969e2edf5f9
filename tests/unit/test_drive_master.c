/*
 * The master of the drives against a port under the test's control: what it sends is kept, what it
 * receives is put in by hand. test_drives_loop.c has the same master with virtual drives.
 */
#include "canopen/cia402.h"
#include "canopen/emcy.h"
#include "canopen/little_endian.h"
#include "canopen/nmt.h"
#include "drive/drives.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define FRAMES_MAX 64

static struct can_frame sent[FRAMES_MAX], pending[FRAMES_MAX];
static unsigned sent_count, pending_count, pending_read;
static uint16_t refused_id; /* frames of this identifier are refused; 0xFFFF: none */

static bool port_send(void *context, const struct can_frame *frame)
{
    (void)context;
    if (frame->id == refused_id)
        return false;
    TEST_ASSERT_TRUE(sent_count < FRAMES_MAX);
    sent[sent_count++] = *frame;
    return true;
}

static bool port_receive(void *context, struct can_frame *frame)
{
    (void)context;
    if (pending_read == pending_count)
        return false;
    *frame = pending[pending_read++];
    return true;
}

static const struct can_port port = {.send = port_send, .receive = port_receive};
static struct drives drives;
static struct point setpoint;

/* Axes X Y Z at nodes 1 2 3, 1000 increments/mm, 0.5 mm following error. */
static struct drives_config three_axes(void)
{
    struct drives_config config = {
        .count = 3, .start_timeout_cycles = 50, .answer_timeout_cycles = 2};
    for (unsigned i = 0; i < 3; i++)
        config.axis[i] =
            (struct drives_config_axis){(enum axis)(AXIS_X + (int)i), (uint8_t)(i + 1), 1000, 0.5};
    return config;
}

void setUp(void)
{
    struct drives_config config = three_axes();
    drives_init(&drives, &config);
    memset(&setpoint, 0, sizeof setpoint);
    refused_id = 0xFFFF;
}

void tearDown(void)
{
}

/* Everything sent in a cycle is in sent[]; what was put in before is received. */
static void cycle(void)
{
    sent_count = 0;
    drives_receive(&drives, &port);
    pending_count = pending_read = 0;
    drives_sync(&drives, &port);
    drives_send(&drives, &port, &setpoint);
}

static void put_status(unsigned node, enum cia402_state state, int32_t actual_inc)
{
    struct can_frame *frame = &pending[pending_count++];
    frame->id = (uint16_t)(PDO_TPDO1_FUNCTION + node);
    frame->length = 6;
    little_endian_write16(frame->data, (uint16_t)(cia402_statusword(state) | 0x1210));
    little_endian_write32(frame->data + 2, (uint32_t)actual_inc);
}

static void put_all(enum cia402_state state, int32_t actual_inc)
{
    for (unsigned node = 1; node <= 3; node++)
        put_status(node, state, actual_inc);
}

static const struct can_frame *find_sent(unsigned id)
{
    for (unsigned i = 0; i < sent_count; i++)
        if (sent[i].id == id)
            return &sent[i];
    return NULL;
}

/* Fails the test if there is none. */
static const struct can_frame *get_sent(unsigned id)
{
    const struct can_frame *frame = find_sent(id);
    if (!frame)
        TEST_FAIL_MESSAGE("the frame has not been sent");
    return frame ? frame : &sent[0];
}

static int32_t sent_target(unsigned id, unsigned offset)
{
    return (int32_t)little_endian_read32(get_sent(id)->data + offset);
}

static void enable_at(int32_t actual_inc)
{
    put_all(CIA402_ENABLED, actual_inc);
    cycle();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
}

/* Runs cycles in which the drives do exactly as told, DRIVES_LATENCY_CYCLES later. */
static void follow(unsigned cycles)
{
    for (unsigned i = 0; i < cycles; i++) {
        put_all(CIA402_ENABLED, (int32_t)lround(setpoint.at[AXIS_X] * 1000));
        cycle();
    }
}

static void assert_fault(enum takt_error error, char axis)
{
    const struct diagnostic *fault = drives_get_fault(&drives);
    TEST_ASSERT_EQUAL_INT(DRIVES_FAULTED, drives_get_state(&drives));
    TEST_ASSERT_EQUAL_INT(error, fault->code);
    TEST_ASSERT_EQUAL_INT(axis, fault->word[0]);
    TEST_ASSERT_EQUAL_INT('\0', fault->word[1]);
}

static void test_the_first_frames_are_sync_and_the_start_of_all_nodes(void)
{
    cycle();
    TEST_ASSERT_EQUAL_HEX16(0x080, sent[0].id);
    TEST_ASSERT_EQUAL_INT(0, sent[0].length);
    const struct can_frame *start = get_sent(0x000);
    TEST_ASSERT_EQUAL_HEX8(NMT_START, start->data[0]);
    TEST_ASSERT_EQUAL_HEX8(NMT_ALL_NODES, start->data[1]);
    cycle();
    TEST_ASSERT_NULL(find_sent(0x000));
}

static void test_a_drive_that_boots_late_is_started_again(void)
{
    cycle();
    cycle();
    nmt_write_heartbeat(&pending[pending_count++], 2, NMT_BOOTED);
    cycle();
    TEST_ASSERT_NOT_NULL(find_sent(0x000));
}

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
    drives_init(&drives, &config);
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

static void test_a_drive_in_fault_stops_all_drives_and_names_its_emergency(void)
{
    struct emcy emcy = {.node = 2, .code = 0x8611};
    enable_at(0);
    emcy_write(&pending[pending_count++], &emcy);
    put_status(1, CIA402_ENABLED, 0);
    put_status(2, CIA402_FAULT_REACTION, 0);
    put_status(3, CIA402_ENABLED, 0);
    cycle();
    assert_fault(TAKT_ERROR_DRIVE_FAULT, 'Y');
    TEST_ASSERT_TRUE(drives_get_fault(&drives)->value == 0x8611);
    for (unsigned node = 1; node <= 3; node++) {
        const struct can_frame *frame = get_sent(0x200 + node);
        TEST_ASSERT_EQUAL_HEX16(0x0002, little_endian_read16(frame->data));
    }
    TEST_ASSERT_NULL(find_sent(0x301));
    cycle();
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
}

static void test_an_emergency_that_comes_after_the_statusword_completes_the_diagnostic(void)
{
    struct emcy emcy = {.node = 3, .code = 0x4310};
    enable_at(0);
    put_status(3, CIA402_FAULT, 0);
    cycle();
    TEST_ASSERT_TRUE(drives_get_fault(&drives)->value == 0);
    emcy_write(&pending[pending_count++], &emcy);
    cycle();
    assert_fault(TAKT_ERROR_DRIVE_FAULT, 'Z');
    TEST_ASSERT_TRUE(drives_get_fault(&drives)->value == 0x4310);
}

static void test_a_drive_that_is_switched_off_or_boots_is_a_fault(void)
{
    enable_at(0);
    put_all(CIA402_ENABLED, 0);
    put_status(1, CIA402_SWITCHED_ON, 0);
    cycle();
    assert_fault(TAKT_ERROR_DRIVE_FAULT, 'X');
    setUp();
    enable_at(0);
    put_all(CIA402_ENABLED, 0);
    nmt_write_heartbeat(&pending[pending_count++], 2, NMT_BOOTED);
    cycle();
    assert_fault(TAKT_ERROR_DRIVE_FAULT, 'Y');
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
        pending[0].length = 5;
        cycle();
    }
    assert_fault(TAKT_ERROR_DRIVE_SILENT, 'X');
}

static void test_drives_that_do_not_get_enabled_in_time_fail_the_start(void)
{
    for (unsigned i = 0; i <= 50; i++) {
        TEST_ASSERT_EQUAL_INT(DRIVES_STARTING, drives_get_state(&drives));
        put_status(1, CIA402_ENABLED, 0);
        put_status(3, CIA402_ENABLED, 0);
        cycle();
    }
    assert_fault(TAKT_ERROR_DRIVE_SILENT, 'Y');
    setUp();
    for (unsigned i = 0; i <= 50; i++) {
        put_all(CIA402_ENABLED, 0);
        put_status(3, CIA402_FAULT, 0);
        cycle();
    }
    assert_fault(TAKT_ERROR_DRIVE_FAULT, 'Z');
}

/*
 * A setpoint that runs at a constant 100 mm/s and drives that report it delay cycles later. At the
 * true delay there is no following error; one cycle more is 0.1 mm.
 */
static void run_delayed(unsigned delay, unsigned cycles)
{
    enable_at(0);
    for (unsigned k = 1; k < cycles; k++) {
        int32_t reached = k > delay ? (int32_t)(100 * (k - delay)) : 0;
        setpoint.at[AXIS_X] = setpoint.at[AXIS_Y] = setpoint.at[AXIS_Z] = 0.1 * k;
        put_all(CIA402_ENABLED, reached);
        cycle();
    }
}

static void test_following_error_is_counted_from_the_setpoint_that_belongs_to_the_report(void)
{
    struct drives_config config = three_axes();
    for (unsigned i = 0; i < 3; i++)
        config.axis[i].following_error_max_mm = 0.05;
    drives_init(&drives, &config);
    run_delayed(DRIVES_LATENCY_CYCLES, 100);
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    drives_init(&drives, &config);
    run_delayed(DRIVES_LATENCY_CYCLES + 1, 100);
    assert_fault(TAKT_ERROR_DRIVE_FOLLOWING, 'X');
    drives_init(&drives, &config);
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
    TEST_ASSERT_TRUE(fabs(drives_get_fault(&drives)->value - 0.501) < 1e-12);
}

static void test_a_setpoint_that_the_bus_refuses_is_a_fault(void)
{
    enable_at(0);
    refused_id = 0x303;
    put_all(CIA402_ENABLED, 0);
    cycle();
    assert_fault(TAKT_ERROR_DRIVE_UNREACHABLE, 'Z');
}

static void test_a_quick_stop_that_the_bus_refuses_is_sent_again(void)
{
    enable_at(0);
    put_all(CIA402_FAULT, 0);
    refused_id = 0x202;
    cycle();
    TEST_ASSERT_NOT_NULL(find_sent(0x201));
    refused_id = 0xFFFF;
    cycle();
    TEST_ASSERT_NULL(find_sent(0x201));
    TEST_ASSERT_NOT_NULL(find_sent(0x202));
}

static void test_frames_of_strangers_are_passed_over(void)
{
    enable_at(0);
    for (unsigned id = 0; id < 0x800; id += 61) {
        struct can_frame frame = {.id = (uint16_t)(id & 0x780 ? id | 0x40 : id), .length = 8};
        pending[pending_count++] = frame;
    }
    put_all(CIA402_ENABLED, 0);
    cycle();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
}

static void test_frames_of_a_cycle_are_those_that_are_sent_and_answered(void)
{
    uint8_t length[DRIVES_CYCLE_FRAMES_MAX];
    static const uint8_t four[] = {0, 8, 8, 6, 6, 6, 6, 6}, three[] = {0, 8, 4, 6, 6, 6, 6};
    TEST_ASSERT_EQUAL_UINT(8, drives_cycle_frames(4, length));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(four, length, 8);
    TEST_ASSERT_EQUAL_UINT(7, drives_cycle_frames(3, length));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(three, length, 7);
    TEST_ASSERT_TRUE(drives_cycle_frames(AXIS_COUNT, length) <= DRIVES_CYCLE_FRAMES_MAX);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_first_frames_are_sync_and_the_start_of_all_nodes);
    RUN_TEST(test_a_drive_that_boots_late_is_started_again);
    RUN_TEST(test_statuswords_lead_to_controlwords_one_drive_a_cycle);
    RUN_TEST(test_a_drive_that_has_said_nothing_gets_no_controlword);
    RUN_TEST(test_targets_are_the_actual_positions_until_a_drive_is_enabled);
    RUN_TEST(test_in_operation_a_cycle_is_sync_and_targets_alone);
    RUN_TEST(test_setpoints_are_rounded_half_away_from_zero);
    RUN_TEST(test_the_ends_of_the_position_range_are_reached_and_not_passed);
    RUN_TEST(test_a_setpoint_that_is_no_number_is_not_sent);
    RUN_TEST(test_drives_that_stand_anywhere_are_enabled_without_following_error);
    RUN_TEST(test_actual_positions_are_reported_by_axis);
    RUN_TEST(test_a_drive_in_fault_stops_all_drives_and_names_its_emergency);
    RUN_TEST(test_an_emergency_that_comes_after_the_statusword_completes_the_diagnostic);
    RUN_TEST(test_a_drive_that_is_switched_off_or_boots_is_a_fault);
    RUN_TEST(test_the_first_fault_is_the_one_that_is_kept);
    RUN_TEST(test_a_silent_drive_is_found_after_the_timeout_and_not_before);
    RUN_TEST(test_a_status_frame_that_is_too_short_is_no_answer);
    RUN_TEST(test_drives_that_do_not_get_enabled_in_time_fail_the_start);
    RUN_TEST(test_following_error_is_counted_from_the_setpoint_that_belongs_to_the_report);
    RUN_TEST(test_a_lagging_axis_is_named_with_its_lag);
    RUN_TEST(test_a_setpoint_that_the_bus_refuses_is_a_fault);
    RUN_TEST(test_a_quick_stop_that_the_bus_refuses_is_sent_again);
    RUN_TEST(test_frames_of_strangers_are_passed_over);
    RUN_TEST(test_frames_of_a_cycle_are_those_that_are_sent_and_answered);
    return UNITY_END();
}
