/* Which drives the start takes, and with which words it refuses the others. */
#include "starting_master.h"

static void assert_refused(enum takt_error error, const char *text)
{
    run_start();
    TEST_ASSERT_EQUAL_INT(error, takt_drives_get_fault(&drives)->code);
    assert_text(text);
    run_until(DRIVES_FAULTED);
    for (unsigned node = 1; node <= DRIVES; node++)
        TEST_ASSERT_NOT_EQUAL(CIA402_ENABLED, shown[node]);
}

static void test_a_node_that_never_boots_is_named(void)
{
    nodes.mute = 2;
    assert_refused(TAKT_ERROR_DRIVE_ABSENT,
                   "the drive of axis Y (node 2) has not booted within 1 s");
}

static void test_a_drive_that_keeps_another_sync_is_refused(void)
{
    static const uint32_t others[] = {0x81, 0x40000080, 0};
    for (unsigned i = 0; i < sizeof others / sizeof others[0]; i++) {
        setUp();
        set_rule((struct fake_rule){.node = 2,
                                    .object = SDO_OBJECT(0x1005, 0),
                                    .value = others[i],
                                    .write_code = SDO_ABORT_READ_ONLY});
        assert_refused(TAKT_ERROR_DRIVE_REFUSES, "the drive of axis Y (node 2), object 1005:00, "
                                                 "refuses with abort code 06090030: invalid value");
    }
}

static void test_a_node_of_another_profile_is_refused(void)
{
    set_rule((struct fake_rule){
        .node = 3, .object = SDO_OBJECT(0x6502, 0), .abort_code = SDO_ABORT_NO_OBJECT});
    set_rule((struct fake_rule){.node = 3, .object = SDO_OBJECT(0x1000, 0), .value = 0x00030191});
    assert_refused(
        TAKT_ERROR_DRIVE_TYPE,
        "axis Z (node 3) has no CiA 402 drive: the device type, object 1000, is 00030191");
}

static void test_another_drive_than_the_machine_file_names_is_refused(void)
{
    config.axis[1].identity = (struct drives_identity){.vendor = 0x11, .product = 0x402};
    set_rule((struct fake_rule){.object = SDO_OBJECT(0x1018, 1), .value = 0x11});
    set_rule((struct fake_rule){.object = SDO_OBJECT(0x1018, 2), .value = 0x403});
    assert_refused(TAKT_ERROR_DRIVE_IDENTITY,
                   "axis Y (node 2) has another drive than the machine file says: its product "
                   "code, object 1018:02, is 0403");
}

static void test_the_drive_the_machine_file_names_is_taken(void)
{
    config.axis[1].identity =
        (struct drives_identity){.vendor = 0x11, .product = 0x402, .revision = 7, .serial = 8};
    for (uint8_t sub = 1; sub <= 4; sub++)
        set_rule((struct fake_rule){.object = SDO_OBJECT(0x1018, sub),
                                    .value = sub == 1   ? 0x11
                                             : sub == 2 ? 0x402
                                                        : sub + 4u});
    run_start();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
}

static void test_a_node_of_another_type_that_tells_modes_is_taken_for_a_drive(void)
{
    static const uint32_t types[] = {0, 4, 0x92010200, 0x000F0191, 0x0002FFFF};
    for (unsigned i = 0; i < sizeof types / sizeof types[0]; i++) {
        setUp();
        set_rule((struct fake_rule){.node = 2, .object = SDO_OBJECT(0x1000, 0), .value = types[i]});
        run_start();
        TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
        TEST_ASSERT_EQUAL_HEX32(1U << DRIVES_NO_TYPE, takt_drives_get_given_up(&drives, AXIS_Y));
    }
}

static void test_a_drive_that_cannot_follow_targets_is_refused(void)
{
    set_rule((struct fake_rule){.object = SDO_OBJECT(0x6502, 0), .value = 0x21});
    assert_refused(TAKT_ERROR_DRIVE_MODES,
                   "the drive of axis X (node 1) has no cyclic position or velocity mode: the "
                   "modes, object 6502, are 0021");
}

static void test_a_refusal_is_told_with_object_code_and_meaning(void)
{
    config.axis[1].identity.vendor = 0x11;
    set_rule((struct fake_rule){
        .node = 2, .object = SDO_OBJECT(0x1018, 1), .abort_code = SDO_ABORT_GENERAL});
    assert_refused(TAKT_ERROR_DRIVE_REFUSES,
                   "the drive of axis Y (node 2), object 1018:01, refuses with abort code "
                   "08000000: general error");
}

static void set_read_only(uint32_t object, uint32_t value)
{
    set_rule(
        (struct fake_rule){.object = object, .value = value, .write_code = SDO_ABORT_READ_ONLY});
}

static void test_what_cannot_be_told_but_is_so_already_is_not_given_up(void)
{
    set_read_only(SDO_OBJECT(0x605E, 0), 2);
    set_read_only(SDO_OBJECT(0x1017, 0), 100);
    run_start();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    TEST_ASSERT_EQUAL_HEX32(0, takt_drives_get_given_up(&drives, AXIS_X));
}

static void test_a_mapping_that_is_refused_since_it_is_so_already_loses_nothing(void)
{
    static const uint32_t there[][2] = {{SDO_OBJECT(0x1600, 1), 0x60400010},
                                        {SDO_OBJECT(0x1600, 2), 0x60600008},
                                        {SDO_OBJECT(0x1A00, 1), 0x60410010},
                                        {SDO_OBJECT(0x1A00, 2), 0x60640020}};
    for (unsigned i = 0; i < sizeof there / sizeof there[0]; i++)
        set_rule((struct fake_rule){
            .object = there[i][0], .value = there[i][1], .write_code = SDO_ABORT_VALUE});
    run_start();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    TEST_ASSERT_EQUAL_HEX32(0, takt_drives_get_given_up(&drives, AXIS_X));
}

static void test_the_same_time_between_targets_in_other_units_is_taken(void)
{
    set_read_only(SDO_OBJECT(0x60C2, 1), 10);
    set_read_only(SDO_OBJECT(0x60C2, 2), 0xFC);
    run_start();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
}

/* 60C2:02 of -3, -4 or -5 for good. */
static void test_a_time_between_targets_is_told_in_the_unit_that_the_drive_keeps(void)
{
    static const uint32_t units[][2] = {{0xFC, 10}, {0xFB, 100}};
    for (unsigned i = 0; i < 2; i++) {
        setUp();
        set_read_only(SDO_OBJECT(0x60C2, 2), units[i][0]);
        run_start();
        TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
        assert_told(1, SDO_OBJECT(0x60C2, 1), units[i][1]);
        TEST_ASSERT_EQUAL_HEX32(0, takt_drives_get_given_up(&drives, AXIS_X));
    }
}

static void test_a_time_that_has_no_value_in_the_unit_of_the_drive_is_refused_with_the_nearest(void)
{
    config.cycle_us = 2400;
    set_read_only(SDO_OBJECT(0x60C2, 2), 0xFD);
    assert_refused(TAKT_ERROR_DRIVE_PERIOD,
                   "the drive of axis X (node 1) keeps 60C2, 2000 us between targets; cycle_us is "
                   "2400");
}

static void test_a_drive_that_keeps_another_time_between_targets_is_refused(void)
{
    set_read_only(SDO_OBJECT(0x60C2, 1), 1);
    set_read_only(SDO_OBJECT(0x60C2, 2), 0xFE);
    assert_refused(TAKT_ERROR_DRIVE_PERIOD,
                   "the drive of axis X (node 1) keeps 60C2, 10000 us between targets; cycle_us is "
                   "1000");
}

static void test_a_drive_that_cannot_report_in_every_cycle_is_refused(void)
{
    for (uint16_t index = 0x1A00; index < 0x1A04; index++)
        set_rule((struct fake_rule){
            .node = 3, .object = SDO_OBJECT(index, 0), .write_code = SDO_ABORT_READ_ONLY});
    assert_refused(TAKT_ERROR_DRIVE_UNMAPPED,
                   "the drive of axis Z (node 3), object 6041:00, is in no PDO of every SYNC and "
                   "refuses: 06010002, object can only be read");
}

static void test_scaling_is_checked_by_the_travel_of_a_turn(void)
{
    config.axis[1].travel_per_turn_mm = 10;
    set_rule((struct fake_rule){.object = SDO_OBJECT(0x6092, 1), .value = 20000});
    set_rule((struct fake_rule){.object = SDO_OBJECT(0x6092, 2), .value = 1});
    set_rule((struct fake_rule){.object = SDO_OBJECT(0x6091, 1), .value = 2});
    set_rule((struct fake_rule){.object = SDO_OBJECT(0x6091, 2), .value = 1});
    run_start();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    setUp();
    config.axis[1].travel_per_turn_mm = 10;
    set_rule((struct fake_rule){.object = SDO_OBJECT(0x608F, 1), .value = 4096});
    set_rule((struct fake_rule){.object = SDO_OBJECT(0x608F, 2), .value = 1});
    assert_refused(TAKT_ERROR_DRIVE_SCALING,
                   "the drive of axis Y (node 2) counts 4096 units in a turn of its motor; "
                   "increments_per_mm says 10000");
}

/* A start where the feed constant is 10000.4 units, half of them in a turn of the motor. */
static void start_with_feed_constant(uint32_t told)
{
    setUp();
    config.axis[1].travel_per_turn_mm = 5.0002;
    set_rule((struct fake_rule){.object = SDO_OBJECT(0x6092, 1), .value = told});
    set_rule((struct fake_rule){.object = SDO_OBJECT(0x6092, 2), .value = 1});
    set_rule((struct fake_rule){.object = SDO_OBJECT(0x6091, 1), .value = 2});
    set_rule((struct fake_rule){.object = SDO_OBJECT(0x6091, 2), .value = 1});
    run_start();
}

static void test_scaling_may_be_off_by_half_a_unit_of_what_is_told_as_a_whole_number(void)
{
    start_with_feed_constant(10000);
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    start_with_feed_constant(10001);
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_DRIVE_SCALING, takt_drives_get_fault(&drives)->code);
}

/* Its target, and its node, which is the first; the others are as they are. */
static void set_up_first(uint32_t target_id)
{
    const uint32_t has[][2] = {
        {SDO_OBJECT(0x1400, 1), 0x201},      {SDO_OBJECT(0x1600, 0), 2},
        {SDO_OBJECT(0x1600, 1), 0x60400010}, {SDO_OBJECT(0x1600, 2), 0x60600008},
        {SDO_OBJECT(0x1401, 1), target_id},  {SDO_OBJECT(0x1401, 2), 1},
        {SDO_OBJECT(0x1601, 0), 1},          {SDO_OBJECT(0x1601, 1), 0x607A0020},
        {SDO_OBJECT(0x1800, 1), 0x40000181}, {SDO_OBJECT(0x1800, 2), 1},
        {SDO_OBJECT(0x1A00, 0), 2},          {SDO_OBJECT(0x1A00, 1), 0x60410010},
        {SDO_OBJECT(0x1A00, 2), 0x60640020}};
    config.axis[0].keeps_settings = true;
    for (unsigned i = 0; i < sizeof has / sizeof has[0]; i++)
        set_rule((struct fake_rule){.node = 1, .object = has[i][0], .value = has[i][1]});
}

static void test_a_drive_that_has_been_set_up_is_told_nothing(void)
{
    config.count = 1;
    set_up_first(0x301);
    run_start();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    TEST_ASSERT_EQUAL_UINT(0, nodes.written_count);
}

static void test_a_drive_that_would_take_the_target_of_another_is_refused(void)
{
    set_up_first(0x303);
    assert_refused(TAKT_ERROR_DRIVE_SHARES,
                   "the drive of axis X (node 1) takes the PDO 0303, which is meant for another "
                   "drive");
}

static void test_a_request_without_an_answer_is_repeated_twice_and_no_more(void)
{
    set_rule((struct fake_rule){.object = SDO_OBJECT(0x1017, 0), .silent = 2});
    run_start();
    TEST_ASSERT_EQUAL_INT(DRIVES_ENABLED, drives_get_state(&drives));
    setUp();
    set_rule((struct fake_rule){.node = 3, .object = SDO_OBJECT(0x1017, 0), .silent = 3});
    assert_refused(TAKT_ERROR_DRIVE_UNANSWERED,
                   "the drive of axis Z (node 3), object 1017:00, does not answer within 10 ms");
}

static void test_a_drive_that_does_not_show_its_mode_is_refused(void)
{
    set_rule((struct fake_rule){.node = 2, .object = SDO_OBJECT(0x6061, 0), .value = 1});
    run_start();
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_DRIVE_MODE, takt_drives_get_fault(&drives)->code);
    assert_text("the drive of axis Y (node 2) does not take the mode 8");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_node_that_never_boots_is_named);
    RUN_TEST(test_a_drive_that_keeps_another_sync_is_refused);
    RUN_TEST(test_a_node_of_another_profile_is_refused);
    RUN_TEST(test_another_drive_than_the_machine_file_names_is_refused);
    RUN_TEST(test_the_drive_the_machine_file_names_is_taken);
    RUN_TEST(test_a_node_of_another_type_that_tells_modes_is_taken_for_a_drive);
    RUN_TEST(test_a_drive_that_cannot_follow_targets_is_refused);
    RUN_TEST(test_a_refusal_is_told_with_object_code_and_meaning);
    RUN_TEST(test_what_cannot_be_told_but_is_so_already_is_not_given_up);
    RUN_TEST(test_a_mapping_that_is_refused_since_it_is_so_already_loses_nothing);
    RUN_TEST(test_the_same_time_between_targets_in_other_units_is_taken);
    RUN_TEST(test_a_time_between_targets_is_told_in_the_unit_that_the_drive_keeps);
    RUN_TEST(test_a_time_that_has_no_value_in_the_unit_of_the_drive_is_refused_with_the_nearest);
    RUN_TEST(test_a_drive_that_keeps_another_time_between_targets_is_refused);
    RUN_TEST(test_a_drive_that_cannot_report_in_every_cycle_is_refused);
    RUN_TEST(test_scaling_is_checked_by_the_travel_of_a_turn);
    RUN_TEST(test_scaling_may_be_off_by_half_a_unit_of_what_is_told_as_a_whole_number);
    RUN_TEST(test_a_drive_that_has_been_set_up_is_told_nothing);
    RUN_TEST(test_a_drive_that_would_take_the_target_of_another_is_refused);
    RUN_TEST(test_a_request_without_an_answer_is_repeated_twice_and_no_more);
    RUN_TEST(test_a_drive_that_does_not_show_its_mode_is_refused);
    return UNITY_END();
}
